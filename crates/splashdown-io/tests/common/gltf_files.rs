//! Small glTF files.

use std::path::Path;

use base64::Engine as _;

/// A node without a transform.
pub const CUBE_AT_ORIGIN: &str = r#"[{"mesh": 0}]"#;

/// A mesh of one primitive, used by some nodes.
pub struct Cube {
    nodes: String,
    scene: String,
    mode: u32,
    vertices: usize,
    corners: usize,
    /// Vertices, then vertex numbers as u16.
    pub buffer: Vec<u8>,
}

impl Cube {
    /// A unit cube as written by exporters, with four vertices per side.
    pub fn new(nodes: &str) -> Self {
        let cube = super::cube([0.0; 3], 1.0);
        let (mut vertices, mut corners) = (Vec::new(), Vec::new());
        for side in cube.triangles.chunks_exact(2) {
            let first = vertices.len() as u16;
            let [a, b, c] = side[0];
            vertices.extend([a, b, c, side[1][2]].map(|index| cube.vertices[index as usize]));
            corners.extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
        }
        Self::of(nodes, &vertices, &corners)
    }

    pub fn of(nodes: &str, vertices: &[[f32; 3]], corners: &[u16]) -> Self {
        let mut buffer: Vec<u8> = vertices.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
        buffer.extend(corners.iter().flat_map(|c| c.to_le_bytes()));
        Self {
            nodes: nodes.to_owned(),
            scene: "[0]".to_owned(),
            mode: 4,
            vertices: vertices.len(),
            corners: corners.len(),
            buffer,
        }
    }

    pub fn scene(mut self, roots: &str) -> Self {
        self.scene = roots.to_owned();
        self
    }

    pub fn mode(mut self, mode: u32) -> Self {
        self.mode = mode;
        self
    }

    /// The JSON with the location of the buffer, e.g. `"uri": "cube.bin",`.
    pub fn json(&self, uri: &str) -> String {
        let Self { nodes, scene, mode, vertices, corners, buffer } = self;
        let (first, rest) = (12 * vertices, 2 * corners);
        format!(
            r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": {scene}}}], "nodes": {nodes},
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1, "mode": {mode}}}]}}],
            "accessors": [
                {{"bufferView": 0, "componentType": 5126, "count": {vertices}, "type": "VEC3", "min": [0,0,0], "max": [1,1,1]}},
                {{"bufferView": 1, "componentType": 5123, "count": {corners}, "type": "SCALAR"}}],
            "bufferViews": [{{"buffer": 0, "byteLength": {first}}},
                {{"buffer": 0, "byteOffset": {first}, "byteLength": {rest}}}],
            "buffers": [{{{uri} "byteLength": {}}}]}}"#,
            buffer.len()
        )
    }
}

pub fn gltf_inside(cube: &Cube) -> String {
    let encoded = base64::engine::general_purpose::STANDARD.encode(&cube.buffer);
    cube.json(&format!("\"uri\": \"data:application/octet-stream;base64,{encoded}\","))
}

/// Writes the buffer into `folder`.
pub fn gltf_beside(cube: &Cube, folder: &Path, name: &str) -> String {
    std::fs::write(folder.join(name), &cube.buffer).unwrap();
    cube.json(&format!("\"uri\": \"{}\",", name.replace(' ', "%20")))
}

pub fn glb(cube: &Cube) -> Vec<u8> {
    glb_of(&cube.json(""), &cube.buffer)
}

pub fn glb_of(json: &str, buffer: &[u8]) -> Vec<u8> {
    let (mut json, mut buffer) = (json.as_bytes().to_vec(), buffer.to_vec());
    json.resize(json.len().next_multiple_of(4), b' ');
    buffer.resize(buffer.len().next_multiple_of(4), 0);
    let chunk = |kind: &[u8], data: &[u8]| {
        let mut chunk = (data.len() as u32).to_le_bytes().to_vec();
        chunk.extend(kind);
        chunk.extend(data);
        chunk
    };
    let body = [chunk(b"JSON", &json), chunk(b"BIN\0", &buffer)].concat();
    let mut file = b"glTF\x02\0\0\0".to_vec();
    file.extend((body.len() as u32 + 12).to_le_bytes());
    file.extend(body);
    file
}
