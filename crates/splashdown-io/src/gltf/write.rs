//! The writer of binary files: JSON that describes the arrays, then the arrays.

use std::io::{self, Write};
use std::path::Path;

use serde_json::{Value, json};

use crate::atomic;
use crate::data::{Mesh, Particles};
use crate::error::IoError;

/// The format's constants for the use of a part of a buffer, and for number types.
pub(super) const ARRAY_BUFFER: u32 = 34962;
pub(super) const ELEMENT_ARRAY_BUFFER: u32 = 34963;
pub(super) const UNSIGNED_INT: u32 = 5125;
pub(super) const FLOAT: u32 = 5126;
/// Largest size of the arrays in bytes. Lengths have 32 bits; the JSON before the arrays is short.
const LARGEST: u64 = u32::MAX as u64 - (1 << 16);
/// Primitive modes.
pub(super) const POINTS: u32 = 0;
pub(super) const TRIANGLES: u32 = 4;

pub(crate) fn write_mesh(path: &Path, mesh: &Mesh) -> Result<u64, IoError> {
    mesh.check()?;
    let size = 36 * mesh.vertices.len() as u64 + 12 * mesh.len() as u64;
    if size > LARGEST {
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
    Arrays::of_mesh(mesh).write_to(out)
}

/// Writes particles as points: a binary file in which `POSITION` is in m and `_VELOCITY` in m/s. The `extras` of the mesh
/// contain the `diameter` in m if the particles have the attribute `width`. Other attributes are left out: Blender 5.0
/// fails at random to import vectors and numbers beside each other. Without particles the scene is empty.
///
/// # Errors
/// Those of [`Particles::check`]; [`IoError::TooMany`] if the file would exceed 4 GB; [`IoError::Write`].
pub fn write_points(path: &Path, particles: &Particles) -> Result<u64, IoError> {
    particles.check()?;
    if 24 * particles.len() as u64 > LARGEST {
        let limit = (LARGEST / 24) as usize;
        return Err(IoError::TooMany { what: "particles", given: particles.len(), limit });
    }
    atomic::write(path, |out| write_points_to(out, particles))
}

/// [`write_points`] to `out`.
///
/// # Errors
/// Those of `out`; `InvalidInput` if [`Particles::check`] fails.
pub fn write_points_to(out: &mut dyn Write, particles: &Particles) -> io::Result<()> {
    particles.check()?;
    Arrays::of_particles(particles).write_to(out)
}

/// The arrays in the order of the file. With triangles, the last one contains their vertex numbers.
struct Arrays<'a> {
    list: Vec<Array<'a>>,
    /// The name of the node.
    name: &'static str,
    /// Mode of the primitive.
    mode: u32,
    /// Diameter of points in m.
    diameter: Option<f32>,
}

struct Array<'a> {
    /// The attribute's name; empty for vertex numbers.
    name: String,
    data: &'a [u8],
    count: usize,
    /// Numbers per element, 1 or 3.
    components: usize,
    /// The smallest and largest components, required for positions.
    bounds: Option<[[f32; 3]; 2]>,
}

impl<'a> Arrays<'a> {
    fn of_mesh(mesh: &'a Mesh) -> Self {
        let mut arrays = Self { list: Vec::new(), name: "surface", mode: TRIANGLES, diameter: None };
        if mesh.is_empty() {
            return arrays;
        }
        arrays.list = vec![
            vectors("POSITION", &mesh.vertices, Some(bounds(&mesh.vertices))),
            vectors("NORMAL", &mesh.normals, None),
            // Names that are not part of the standard begin with an underscore.
            vectors("_VELOCITY", &mesh.velocities, None),
        ];
        arrays.list.retain(|array| array.count > 0);
        let data = bytemuck::cast_slice(&mesh.triangles);
        arrays.list.push(Array {
            name: String::new(),
            data,
            count: 3 * mesh.len(),
            components: 1,
            bounds: None,
        });
        arrays
    }

    fn of_particles(particles: &'a Particles) -> Self {
        let Particles { positions, velocities, .. } = particles;
        let mut list = Vec::new();
        if !positions.is_empty() {
            list.push(vectors("POSITION", positions, Some(bounds(positions))));
            list.push(vectors("_VELOCITY", velocities, None));
            list.retain(|array| array.count > 0);
        }
        let width = particles.attributes.iter().find(|attribute| attribute.name == "width");
        let diameter = width.and_then(|width| width.values.first().copied());
        Self { list, name: "points", mode: POINTS, diameter }
    }

    fn write_to(&self, out: &mut dyn Write) -> io::Result<()> {
        write_file(out, &self.document(), self.bytes(), |out| {
            self.list.iter().try_for_each(|array| out.write_all(array.data))
        })
    }

    fn bytes(&self) -> usize {
        self.list.iter().map(|array| array.data.len()).sum()
    }

    fn document(&self) -> Value {
        let asset = json!({ "version": "2.0", "generator": "Splashdown" });
        if self.list.is_empty() {
            return json!({ "asset": asset, "scene": 0, "scenes": [{ "name": format!("no {}", self.name) }] });
        }
        let named = self.list.iter().enumerate().filter(|(_, array)| !array.name.is_empty());
        let named = named.map(|(n, array)| (array.name.clone(), json!(n)));
        let attributes: serde_json::Map<String, Value> = named.collect();
        let mut offset = 0;
        let (mut views, mut accessors) = (Vec::new(), Vec::new());
        for (number, Array { name, data, count, components, bounds }) in self.list.iter().enumerate() {
            let corners = name.is_empty();
            let target = if corners { ELEMENT_ARRAY_BUFFER } else { ARRAY_BUFFER };
            let view =
                json!({ "buffer": 0, "byteOffset": offset, "byteLength": data.len(), "target": target });
            views.push(view);
            offset += data.len();
            let kind = if corners { UNSIGNED_INT } else { FLOAT };
            let shape = if *components == 3 { "VEC3" } else { "SCALAR" };
            let mut accessor =
                json!({ "bufferView": number, "componentType": kind, "count": count, "type": shape });
            if let Some([low, high]) = bounds {
                accessor["min"] = json!(low);
                accessor["max"] = json!(high);
            }
            accessors.push(accessor);
        }
        let mut primitive = json!({ "attributes": attributes, "material": 0, "mode": self.mode });
        if self.mode == TRIANGLES {
            primitive["indices"] = json!(self.list.len() - 1);
        }
        let mut mesh = json!({ "name": self.name, "primitives": [primitive] });
        if let Some(diameter) = self.diameter {
            mesh["extras"] = json!({ "diameter": diameter });
        }
        json!({
            "asset": asset,
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": [{ "mesh": 0, "name": self.name }],
            "meshes": [mesh],
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

/// Writes a file: its description, and arrays of this many bytes, a multiple of four.
pub(super) fn write_file(
    out: &mut dyn Write,
    document: &Value,
    bytes: usize,
    arrays: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut json = document.to_string().into_bytes();
    // The size of a chunk is a multiple of four; spaces may follow the JSON.
    json.resize(json.len().next_multiple_of(4), b' ');
    let total = 12 + 8 + json.len() + if bytes > 0 { 8 + bytes } else { 0 };
    let Ok(total) = u32::try_from(total) else {
        let reason = format!("{total} bytes are too many for a GLB file, which has at most 4 GB");
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, reason));
    };
    out.write_all(b"glTF")?;
    for word in [2, total, json.len() as u32] {
        out.write_all(&word.to_le_bytes())?;
    }
    out.write_all(b"JSON")?;
    out.write_all(&json)?;
    if bytes > 0 {
        out.write_all(&(bytes as u32).to_le_bytes())?;
        out.write_all(b"BIN\0")?;
        arrays(out)?;
    }
    Ok(())
}

/// An array of vectors.
fn vectors<'a>(name: &str, values: &'a [[f32; 3]], bounds: Option<[[f32; 3]; 2]>) -> Array<'a> {
    let data = bytemuck::cast_slice(values);
    Array { name: name.to_owned(), data, count: values.len(), components: 3, bounds }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Attribute;

    /// The JSON and the arrays of a binary file.
    fn parts(bytes: &[u8]) -> (Value, &[u8]) {
        let length = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!((&bytes[..4], length(8)), (&b"glTF"[..], bytes.len()));
        let json = length(12);
        (serde_json::from_slice(&bytes[20..20 + json]).unwrap(), bytes.get(28 + json..).unwrap_or_default())
    }

    #[test]
    fn points_have_velocities_and_a_diameter() {
        let width = Attribute { name: "width".to_owned(), components: 1, values: vec![0.5, 0.5] };
        let particles = Particles::from_positions(vec![[0.0, 1.0, 2.0], [-1.0, 3.0, 2.0]])
            .with_velocities(vec![[4.0, 5.0, 6.0], [7.0, 8.0, 9.0]])
            .with_attributes(vec![width]);
        let mut bytes = Vec::new();
        write_points_to(&mut bytes, &particles).unwrap();
        let (json, arrays) = parts(&bytes);
        let primitive = &json["meshes"][0]["primitives"][0];
        assert_eq!(primitive["mode"], 0);
        assert_eq!(primitive.get("indices"), None);
        assert_eq!(primitive["attributes"], json!({ "POSITION": 0, "_VELOCITY": 1 }));
        assert_eq!(json["meshes"][0]["extras"]["diameter"], 0.5);
        assert_eq!(json["accessors"][0]["min"], json!([-1.0, 1.0, 2.0]));
        let shapes: Vec<&Value> = (0..2).map(|i| &json["accessors"][i]["type"]).collect();
        assert_eq!(shapes, ["VEC3", "VEC3"]);
        assert_eq!(arrays.len(), 48);
        assert_eq!(bytemuck::pod_collect_to_vec::<u8, f32>(&arrays[24..36]), [4.0, 5.0, 6.0]);
    }

    #[test]
    fn without_particles_the_scene_is_empty() {
        let mut bytes = Vec::new();
        write_points_to(&mut bytes, &Particles::default()).unwrap();
        let (json, arrays) = parts(&bytes);
        assert!(json.get("meshes").is_none() && arrays.is_empty());
        let particles = Particles::from_positions(vec![[0.0; 3]]).with_velocities(vec![[0.0; 3]; 2]);
        assert!(write_points_to(&mut bytes, &particles).is_err());
    }
}
