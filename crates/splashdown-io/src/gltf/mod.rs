//! glTF 2.0, the format of web and game tools: JSON with buffers inside or in other files (`.gltf`), or one binary file
//! (`.glb`). A reader of both and a writer of binary files.
//!
//! The reader joins all meshes of the default scene (the first one if none is named), transformed by their nodes. The
//! triangles of a mirrored mesh are flipped, so that they still face outwards. Vertices at the same position are merged,
//! because glTF splits them where normals or texture coordinates differ. Materials, pictures, skins and animations are
//! skipped; geometry compressed by an extension (Draco, meshopt, quantisation) is refused.
//!
//! *Why own code:* `gltf` 1.4 panics on files with a number out of range, even in its validation, and does not check
//! offsets and counts of arrays; triangles need few of the format's fields. Format: Khronos, "glTF 2.0 Specification".

mod buffers;
mod document;
mod stage;
mod transform;
mod write;

pub(crate) use stage::{LARGEST, write_stage};
pub(crate) use write::write_mesh;
pub use write::{write_mesh_to, write_points, write_points_to};

use std::path::Path;

use self::buffers::Buffers;
use self::document::{Document, Primitive};
use self::transform::{Affine, apply, mirrors, nodes_with_transforms};
use crate::data::Mesh;
use crate::error::IoError;
use crate::input::{MAX_COUNT, Welder, content};
use crate::limit::Budget;

/// Primitive modes of the format that are surfaces.
const TRIANGLES: u32 = 4;
const TRIANGLE_STRIP: u32 = 5;
const TRIANGLE_FAN: u32 = 6;

pub(crate) fn read_mesh(path: &Path) -> Result<Mesh, IoError> {
    let bytes = content(path)?;
    let malformed = |reason: String| IoError::malformed(path, "glTF", reason);
    let (document, blob) = Document::parse(&bytes).map_err(malformed)?;
    let budget = Budget::of_file(bytes.len() as u64 + document.external_bytes());
    let mut scene = Scene { buffers: Buffers::new(path, &document, blob), welder: Welder::default(), budget };
    for (node, transform) in nodes_with_transforms(&document).map_err(malformed)? {
        let Some(number) = node.mesh else { continue };
        let mesh = document.meshes.get(number).ok_or_else(|| {
            malformed(format!("it uses mesh {number}, but has {} (numbered from 0)", document.meshes.len()))
        })?;
        for primitive in &mesh.primitives {
            scene.add(number, primitive, &transform)?;
        }
    }
    Ok(scene.welder.into_mesh())
}

/// The state of the reader.
struct Scene<'a> {
    buffers: Buffers<'a>,
    welder: Welder,
    budget: Budget,
}

impl Scene<'_> {
    /// Adds one primitive of mesh `number`; points and lines are skipped.
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
                "in mesh {number}: the number of its corners, {}, is not a multiple of 3",
                corners.len()
            )));
        }
        // Many nodes may refer to one mesh, so the size of the file does not limit the size of the result.
        let bounds = [
            ("vertices", self.welder.vertices() + positions.len()),
            ("triangles", self.welder.triangles() + corners.len()),
        ];
        let bytes = 12 * (positions.len() as u64 + corners.len() as u64);
        self.budget
            .take(bytes, format_args!("mesh {number}"))
            .map_err(|reason| self.buffers.malformed(reason))?;
        for (what, given) in bounds {
            if given > MAX_COUNT {
                return Err(IoError::TooMany { what, given, limit: MAX_COUNT });
            }
        }

        let welder = &mut self.welder;
        let vertices: Vec<_> =
            positions.into_iter().map(|position| welder.vertex(apply(transform, position))).collect();
        let mirrored = mirrors(transform);
        let mut push = |triangle: [u32; 3]| {
            let [a, b, c] = triangle.map(|corner| vertices[corner as usize]);
            welder.push(if mirrored { [a, c, b] } else { [a, b, c] });
        };
        match (mode, corners.as_slice()) {
            // Every other triangle of a strip has the opposite orientation.
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
