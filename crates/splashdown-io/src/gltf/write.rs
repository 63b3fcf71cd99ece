//! The writer of binary files: JSON that describes the arrays, then the arrays.

use std::io::{self, Write};
use std::path::Path;

use serde_json::{Value, json};

use crate::atomic;
use crate::data::Mesh;
use crate::error::IoError;

/// The format's constants for the use of a part of a buffer, and for number types.
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;

pub(crate) fn write_mesh(path: &Path, mesh: &Mesh) -> Result<u64, IoError> {
    mesh.check()?;
    // Lengths have 32 bits; the JSON before the arrays is short.
    let size = 36 * mesh.vertices.len() as u64 + 12 * mesh.len() as u64;
    if size > u64::from(u32::MAX - (1 << 16)) {
        return Err(IoError::TooMany { what: "vertices", given: mesh.vertices.len(), limit: 60_000_000 });
    }
    atomic::write(path, |out| write_mesh_to(out, mesh))
}

/// Writes a mesh to `out`. Normals are the attribute `NORMAL`; velocities are `_VELOCITY`, in m/s. A mesh without
/// triangles becomes an empty scene, because the format has no empty arrays.
///
/// # Errors
/// Those of `out`; `InvalidInput` if [`Mesh::check`] fails.
pub fn write_mesh_to(out: &mut dyn Write, mesh: &Mesh) -> io::Result<()> {
    mesh.check()?;
    let arrays = Arrays::of(mesh);
    let mut json = arrays.document().to_string().into_bytes();
    // The size of a chunk is a multiple of four; spaces may follow the JSON.
    json.resize(json.len().next_multiple_of(4), b' ');
    let blob = arrays.bytes();
    let total = 12 + 8 + json.len() + if blob > 0 { 8 + blob } else { 0 };
    out.write_all(b"glTF")?;
    for word in [2, total as u32, json.len() as u32] {
        out.write_all(&word.to_le_bytes())?;
    }
    out.write_all(b"JSON")?;
    out.write_all(&json)?;
    if blob > 0 {
        out.write_all(&(blob as u32).to_le_bytes())?;
        out.write_all(b"BIN\0")?;
        for array in &arrays.0 {
            out.write_all(array.data)?;
        }
    }
    Ok(())
}

/// The arrays in the order of the file. The last one contains the vertex numbers of the triangles.
struct Arrays<'a>(Vec<Array<'a>>);

struct Array<'a> {
    /// The attribute's name; empty for vertex numbers.
    name: &'static str,
    data: &'a [u8],
    count: usize,
    /// The smallest and largest components, required for positions.
    bounds: Option<[[f32; 3]; 2]>,
}

impl<'a> Arrays<'a> {
    fn of(mesh: &'a Mesh) -> Self {
        if mesh.is_empty() {
            return Self(Vec::new());
        }
        let vectors = |name, values: &'a [[f32; 3]], bounds| Array {
            name,
            data: bytemuck::cast_slice(values),
            count: values.len(),
            bounds,
        };
        let mut arrays = vec![
            vectors("POSITION", &mesh.vertices, Some(bounds(&mesh.vertices))),
            vectors("NORMAL", &mesh.normals, None),
            // Names that are not part of the standard begin with an underscore.
            vectors("_VELOCITY", &mesh.velocities, None),
        ];
        arrays.retain(|array| array.count > 0);
        let corners = bytemuck::cast_slice(&mesh.triangles);
        arrays.push(Array { name: "", data: corners, count: 3 * mesh.len(), bounds: None });
        Self(arrays)
    }

    fn bytes(&self) -> usize {
        self.0.iter().map(|array| array.data.len()).sum()
    }

    fn document(&self) -> Value {
        let asset = json!({ "version": "2.0", "generator": "Splashdown" });
        let Some((_, attributes)) = self.0.split_last() else {
            return json!({ "asset": asset, "scene": 0, "scenes": [{ "name": "no surface" }] });
        };
        let named = attributes.iter().enumerate().map(|(n, array)| (array.name.to_owned(), json!(n)));
        let attributes: serde_json::Map<String, Value> = named.collect();
        let mut offset = 0;
        let (mut views, mut accessors) = (Vec::new(), Vec::new());
        for (number, Array { name, data, count, bounds }) in self.0.iter().enumerate() {
            let corners = name.is_empty();
            let target = if corners { ELEMENT_ARRAY_BUFFER } else { ARRAY_BUFFER };
            let view =
                json!({ "buffer": 0, "byteOffset": offset, "byteLength": data.len(), "target": target });
            views.push(view);
            offset += data.len();
            let (kind, shape) = if corners { (UNSIGNED_INT, "SCALAR") } else { (FLOAT, "VEC3") };
            let mut accessor =
                json!({ "bufferView": number, "componentType": kind, "count": count, "type": shape });
            if let Some([low, high]) = bounds {
                accessor["min"] = json!(low);
                accessor["max"] = json!(high);
            }
            accessors.push(accessor);
        }
        json!({
            "asset": asset,
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": [{ "mesh": 0, "name": "surface" }],
            "meshes": [{
                "name": "surface",
                "primitives": [{ "attributes": attributes, "indices": self.0.len() - 1, "material": 0 }],
            }],
            "materials": [{
                "name": "water",
                "pbrMetallicRoughness": {
                    "baseColorFactor": [0.2, 0.45, 0.6, 1.0],
                    "metallicFactor": 0.0,
                    "roughnessFactor": 0.1,
                },
            }],
            "accessors": accessors,
            "bufferViews": views,
            "buffers": [{ "byteLength": offset }],
        })
    }
}

/// The smallest and largest finite components; JSON has no other numbers.
fn bounds(points: &[[f32; 3]]) -> [[f32; 3]; 2] {
    let of = |choose: fn(f32, f32) -> f32| {
        std::array::from_fn(|axis| {
            let finite = points.iter().map(|point| point[axis]).filter(|component| component.is_finite());
            finite.reduce(choose).unwrap_or(0.0)
        })
    };
    [of(f32::min), of(f32::max)]
}
