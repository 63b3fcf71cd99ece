//! glTF 2.0, the format of web and game tools: JSON with buffers beside it or inside (`.gltf`), or one binary file
//! (`.glb`): a reader of both and a writer of the second.
//!
//! All meshes of the default scene become one, each placed by its nodes. Materials, pictures, skins and animations
//! are passed over; geometry that is packed by an extension (Draco, meshopt, quantised) is refused by name.
//!
//! *Why own code:* `gltf` 1.4 panics on files with a number out of range, in its check of the file already, and takes
//! offsets and counts of arrays for true; a file's triangles need few of the format's fields. Format: Khronos,
//! "glTF 2.0 Specification".

mod buffers;
mod document;
mod transform;
mod write;

pub use write::{write_mesh, write_mesh_to};

use std::path::Path;

use self::buffers::Buffers;
use self::document::{Document, Primitive};
use self::transform::{Affine, mirrors, place, placed};
use crate::data::Mesh;
use crate::error::IoError;
use crate::input::{MOST, Welder, content};

/// The kinds of primitives that are surfaces, by their numbers in the format.
const TRIANGLES: u32 = 4;
const TRIANGLE_STRIP: u32 = 5;
const TRIANGLE_FAN: u32 = 6;

/// Reads the meshes of the default scene (the first, where none is named) of a glTF file, as text or binary.
///
/// Node transforms are applied; one that mirrors turns the triangles' order round, so that they keep facing outwards.
/// Vertices at the same place become one, because glTF cuts them apart where their normals or textures differ.
///
/// # Errors
/// [`IoError::Read`] for the file or a buffer beside it; [`IoError::Malformed`]; [`IoError::TooMany`].
pub fn read_mesh(path: &Path) -> Result<Mesh, IoError> {
    let bytes = content(path)?;
    let malformed = |reason: String| IoError::malformed(path, "glTF", reason);
    let (document, blob) = Document::parse(&bytes).map_err(malformed)?;
    let mut scene = Scene { buffers: Buffers::new(path, &document, blob), welder: Welder::default() };
    for (node, transform) in placed(&document).map_err(malformed)? {
        let Some(number) = node.mesh else { continue };
        let mesh = document.meshes.get(number).ok_or_else(|| {
            malformed(format!("it names mesh {number}, but holds {} (from 0)", document.meshes.len()))
        })?;
        for primitive in &mesh.primitives {
            scene.add(number, primitive, &transform)?;
        }
    }
    Ok(scene.welder.into_mesh())
}

/// What has been read so far.
struct Scene<'a> {
    buffers: Buffers<'a>,
    welder: Welder,
}

impl Scene<'_> {
    /// Adds one primitive of mesh `number`; points and lines are passed over.
    fn add(&mut self, number: usize, primitive: &Primitive, transform: &Affine) -> Result<(), IoError> {
        let mode = primitive.mode.unwrap_or(TRIANGLES);
        let surface = matches!(mode, TRIANGLES | TRIANGLE_STRIP | TRIANGLE_FAN);
        let Some(position) = primitive.attributes.position.filter(|_| surface) else { return Ok(()) };
        let positions = self.buffers.positions(position)?;
        let corners = match primitive.indices {
            Some(indices) => self.buffers.indices(indices)?,
            None => (0..positions.len() as u32).collect(),
        };
        if let Some(&wrong) = corners.iter().find(|&&corner| corner as usize >= positions.len()) {
            let count = positions.len();
            return Err(self.buffers.malformed(format!(
                "in mesh {number}: a triangle uses vertex {wrong}, but there are {count} vertices (numbered from 0)"
            )));
        }
        if mode == TRIANGLES && !corners.len().is_multiple_of(3) {
            return Err(self.buffers.malformed(format!(
                "in mesh {number}: its {} corners are no whole number of triangles",
                corners.len()
            )));
        }
        // Many nodes may show one mesh, so the file's size bounds nothing.
        let bounds = [
            ("vertices", self.welder.vertices() + positions.len()),
            ("triangles", self.welder.triangles() + corners.len()),
        ];
        for (what, given) in bounds {
            if given > MOST {
                return Err(IoError::TooMany { what, given, limit: MOST });
            }
        }

        let welder = &mut self.welder;
        let placed: Vec<_> =
            positions.into_iter().map(|position| welder.vertex(place(position, transform))).collect();
        let mirrored = mirrors(transform);
        let mut push = |triangle: [u32; 3]| {
            let [a, b, c] = triangle.map(|corner| placed[corner as usize]);
            welder.push(if mirrored { [a, c, b] } else { [a, b, c] });
        };
        match (mode, corners.as_slice()) {
            // Every other triangle of a strip runs the other way round.
            (TRIANGLE_STRIP, _) => corners.windows(3).enumerate().for_each(|(number, t)| {
                push(if number % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] });
            }),
            (TRIANGLE_FAN, [first, rest @ ..]) => {
                rest.windows(2).for_each(|pair| push([*first, pair[0], pair[1]]));
            }
            _ => corners.chunks_exact(3).for_each(|t| push([t[0], t[1], t[2]])),
        }
        Ok(())
    }
}
