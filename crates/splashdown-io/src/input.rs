//! What the readers of meshes and particles share.

use std::collections::HashMap;
use std::fs;
use std::io;
use std::path::Path;

use crate::data::Mesh;
use crate::error::IoError;

/// The most particles, or triangles or vertices of one mesh, that are read: some gigabytes. A small file can
/// name a large mesh many times (glTF), and must not take all memory.
pub(crate) const MOST: usize = 1 << 27;

/// The ending of a file name in lower case, without its dot.
pub(crate) fn extension(path: &Path) -> Option<String> {
    Some(path.extension()?.to_str()?.to_ascii_lowercase())
}

/// Why a mesh is not read as particles.
pub(crate) fn not_particles(faces: usize) -> String {
    let plural = if faces == 1 { "" } else { "s" };
    format!(
        "it is a mesh of {faces} face{plural}, and the vertices of a mesh are not particles: give the particles themselves"
    )
}

/// A pipe or device may never end.
pub(crate) fn regular(path: &Path) -> Result<(), IoError> {
    let metadata = fs::metadata(path).map_err(|error| IoError::read(path, &error))?;
    if metadata.is_file() {
        return Ok(());
    }
    let what = if metadata.is_dir() { "it is a folder, not a file" } else { "it is not a regular file" };
    Err(IoError::Read { path: path.to_owned(), detail: what.to_owned() })
}

/// All bytes of a regular file.
pub(crate) fn content(path: &Path) -> Result<Vec<u8>, IoError> {
    regular(path)?;
    fs::read(path).map_err(|error: io::Error| IoError::read(path, &error))
}

/// Cuts a polygon into triangles that share its first corner.
pub(crate) fn push_fan(triangles: &mut Vec<[u32; 3]>, corners: &[u32]) -> Result<(), String> {
    match corners {
        [first, rest @ ..] if rest.len() >= 2 => {
            triangles.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
            Ok(())
        }
        _ => Err(format!("a face with {} corners, at least 3 are needed", corners.len())),
    }
}

/// Collects loose triangles into a mesh in which equal places are one vertex.
#[derive(Default)]
pub(crate) struct Welder {
    mesh: Mesh,
    known: HashMap<[u32; 3], u32>,
}

impl Welder {
    /// The number of the vertex at this place. Bits are compared, with both zeros the same.
    pub(crate) fn vertex(&mut self, position: [f32; 3]) -> u32 {
        let position = position.map(|component| component + 0.0);
        // The files that are read stay below 2^32 corners: they are checked against their size or `MOST`.
        let next = self.mesh.vertices.len() as u32;
        let index = *self.known.entry(position.map(f32::to_bits)).or_insert(next);
        if index == next {
            self.mesh.vertices.push(position);
        }
        index
    }

    pub(crate) fn triangle(&mut self, corners: [[f32; 3]; 3]) {
        let triangle = corners.map(|corner| self.vertex(corner));
        self.mesh.triangles.push(triangle);
    }

    /// Adds a triangle of vertices that have their numbers from [`Self::vertex`].
    pub(crate) fn push(&mut self, triangle: [u32; 3]) {
        self.mesh.triangles.push(triangle);
    }

    /// Vertices collected so far.
    pub(crate) fn vertices(&self) -> usize {
        self.mesh.vertices.len()
    }

    /// Triangles collected so far.
    pub(crate) fn triangles(&self) -> usize {
        self.mesh.len()
    }

    pub(crate) fn into_mesh(self) -> Mesh {
        self.mesh
    }
}
