//! Valid files from which the search starts.

use std::fs;
use std::io::Write as _;

use anyhow::{Context, Result};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use splashdown::scene::{Scene, presets};
use splashdown::{Device, Event, Run, RunOptions};
use splashdown_io::{
    Attribute, Mesh, ParticleInfo, Particles, Picture, picture, write_mesh, write_particles,
};

/// A scene of a few particles.
pub const SMALL: &str = "\
[scene]
name = \"small\"
duration = 0.01
frame_rate = 200
[domain]
min = [0, 0, 0]
max = [0.4, 0.4, 0.4]
[fluid]
particle_spacing = 0.1
[[fluid.block]]
position = [0, 0, 0]
size = [0.2, 0.2, 0.2]
[[probe]]
name = \"level\"
quantity = \"height\"
position = [0.1, 0, 0.1]
";

/// Particles with all fields and other attributes.
fn particles() -> Particles {
    let count = 20;
    let value = |n: usize| n as f32 * 0.5 - 1.0;
    let mut particles =
        Particles::from_positions((0..count).map(|n| [value(n), value(n + 1), 0.25]).collect());
    particles.velocities = (0..count).map(|n| [value(n), 0.0, -value(n)]).collect();
    particles.densities = vec![1000.0; count];
    particles.pressures = (0..count).map(value).collect();
    particles.ids = (0..count as u32).collect();
    particles.info = ParticleInfo::new(0.5, 0.5);
    particles.attributes.push(Attribute {
        name: "temperature".to_owned(),
        components: 1,
        values: (0..count).map(value).collect(),
    });
    particles.attributes.push(Attribute {
        name: "force".to_owned(),
        components: 3,
        values: (0..3 * count).map(value).collect(),
    });
    particles
}

/// A tetrahedron.
fn mesh() -> Mesh {
    let vertices = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    Mesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
}

/// A particle file with this ending, as the library writes it.
pub fn particle_file(ending: &str) -> Result<Vec<u8>> {
    let path = tempfile::tempdir()?.keep().join(format!("a{ending}"));
    write_particles(&path, &particles())?;
    take(&path)
}

/// A mesh file with this ending, as the library writes it.
pub fn mesh_file(ending: &str) -> Result<Vec<u8>> {
    let path = tempfile::tempdir()?.keep().join(format!("a{ending}"));
    write_mesh(&path, &mesh())?;
    take(&path)
}

/// The content of a file, which is removed with its folder.
fn take(path: &std::path::Path) -> Result<Vec<u8>> {
    let bytes = fs::read(path)?;
    fs::remove_dir_all(path.parent().context("the file has no folder")?)?;
    Ok(bytes)
}

/// A picture.
pub fn png() -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let rgba = (0..8 * 6 * 4).map(|n| n as u8).collect();
    picture::write_png_to(&mut bytes, &Picture { width: 8, height: 6, rgba })?;
    Ok(bytes)
}

/// An NPY file of the format version 1.
pub fn npy(kind: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}\n");
    let length = (header.len() as u16).to_le_bytes();
    [b"\x93NUMPY\x01\x00", &length[..], header.as_bytes(), data].concat()
}

/// A glTF file with two nodes, a strip and a buffer inside.
pub fn gltf() -> Vec<u8> {
    let json = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"nodes": [{"children": [1], "scale": [1, 2, 1]}, {"mesh": 0, "translation": [1, 0, 0], "rotation": [0, 0, 0, 1]}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": 4}]}],
"accessors": [{"bufferView": 0, "byteOffset": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
{"bufferView": 1, "componentType": 5121, "count": 3, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36, "byteStride": 12},
{"buffer": 0, "byteOffset": 36, "byteLength": 3}],
"buffers": [{"byteLength": 39, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAEC"}]}"#;
    json.as_bytes().to_vec()
}

/// A VTU file as other programs write it: arrays as text and as base64 of zlib.
pub fn vtu_text() -> Vec<u8> {
    let densities: Vec<u8> = [1000.0_f64, 999.0].iter().flat_map(|density| density.to_le_bytes()).collect();
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
    let packed = encoder.write_all(&densities).and_then(|()| encoder.finish()).unwrap_or_default();
    // One block of 16 bytes, and its size.
    let sizes = [1, 16, 0, packed.len() as u32].map(u32::to_le_bytes);
    let densities = STANDARD.encode(sizes.as_flattened()) + &STANDARD.encode(&packed);
    let text = r#"<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt32" compressor="vtkZLibDataCompressor">
<UnstructuredGrid><Piece NumberOfPoints="2" NumberOfCells="0"><Points>
<DataArray type="Float32" NumberOfComponents="3" format="ascii">0 0 0 1 2 3</DataArray></Points>
<PointData><DataArray type="Int32" Name="id" format="ascii">4 5</DataArray>
<DataArray type="Float64" Name="density" format="binary">DENSITIES</DataArray>
</PointData></Piece></UnstructuredGrid></VTKFile>"#;
    text.replace("DENSITIES", &densities).into_bytes()
}

/// The scenes that come with the program, and a small one.
pub fn scenes() -> Vec<Vec<u8>> {
    let built_in = presets().iter().map(|(_, text)| text.as_bytes().to_vec());
    built_in.chain([SMALL.as_bytes().to_vec()]).collect()
}

/// A checkpoint of the small scene.
pub fn checkpoint() -> Result<Vec<u8>> {
    let scene = Scene::parse(SMALL, "small.toml")?;
    let mut options = RunOptions::new(&scene).with_frames(1);
    options.device = Device::Cpu;
    let mut run = Run::new(&scene, options)?;
    for event in run.by_ref() {
        if matches!(event?, Event::Frame(frame) if frame.index == 1) {
            break;
        }
    }
    Ok(run.checkpoint()?.to_bytes()?)
}
