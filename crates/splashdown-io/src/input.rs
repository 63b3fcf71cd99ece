//! Functions that the readers of meshes and particles share.

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use crate::data::Mesh;
use crate::error::IoError;

/// The largest number of particles, or of triangles or vertices of a mesh, that is read. They need some gigabytes. A
/// small glTF file can refer to a large mesh many times, and must not exhaust the memory.
pub(crate) const MAX_COUNT: usize = 1 << 27;

/// The reason why a mesh is not read as particles.
pub(crate) fn not_particles(faces: usize) -> String {
    let plural = if faces == 1 { "" } else { "s" };
    format!(
        "it is a mesh of {faces} face{plural}, and the vertices of a mesh are not particles: give a file of particles"
    )
}

/// Refuses a folder, and a pipe or device, whose data may never end.
pub(crate) fn regular(path: &Path) -> Result<(), IoError> {
    let metadata = fs::metadata(path).map_err(|error| IoError::read(path, &error))?;
    if metadata.is_file() {
        return Ok(());
    }
    let what = if metadata.is_dir() {
        "it is a folder, not a file"
    } else {
        "it is not a regular file but a pipe or device; save its data to a file first"
    };
    Err(IoError::Read { path: path.to_owned(), detail: what.to_owned() })
}

/// All bytes of a regular file.
pub(crate) fn content(path: &Path) -> Result<Vec<u8>, IoError> {
    regular(path)?;
    fs::read(path).map_err(|error| IoError::read(path, &error))
}

/// Splits a polygon into triangles that share its first vertex.
pub(crate) fn push_fan(triangles: &mut Vec<[u32; 3]>, corners: &[u32]) -> Result<(), String> {
    match corners {
        [first, rest @ ..] if rest.len() >= 2 => {
            triangles.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
            Ok(())
        }
        _ => Err(format!("a face with {} corners, at least 3 are needed", corners.len())),
    }
}

/// Adds polygons. `corners` are the vertex numbers of all polygons, `ends` the positions after the last corner of each;
/// those for whose number `is_polygon` is false are skipped.
pub(crate) fn push_polygons(
    triangles: &mut Vec<[u32; 3]>,
    corners: &[u32],
    ends: &[u32],
    is_polygon: impl Fn(usize) -> bool,
) -> Result<(), String> {
    let mut start = 0;
    for (number, &end) in ends.iter().enumerate() {
        let polygon = corners.get(start..end as usize).ok_or_else(|| {
            format!("polygon {number} ends at {end}, which is not a position in its list of corners")
        })?;
        start = end as usize;
        if is_polygon(number) {
            push_fan(triangles, polygon)?;
        }
    }
    Ok(())
}

/// Collects separate triangles into a mesh in which vertices at the same position are merged.
#[derive(Default)]
pub(crate) struct Welder {
    mesh: Mesh,
    known: HashMap<[u32; 3], u32>,
}

impl Welder {
    /// The number of the vertex at this position. Positions are compared bit by bit, with both zeros equal.
    pub(crate) fn vertex(&mut self, position: [f32; 3]) -> u32 {
        let position = position.map(|component| component + 0.0);
        // Files have fewer than 2^32 corners: their counts were compared with their size or `MAX_COUNT`.
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

    /// Adds a triangle of vertex numbers returned by [`Self::vertex`].
    pub(crate) fn push(&mut self, triangle: [u32; 3]) {
        self.mesh.triangles.push(triangle);
    }

    /// Number of vertices so far.
    pub(crate) fn vertices(&self) -> usize {
        self.mesh.vertices.len()
    }

    /// Number of triangles so far.
    pub(crate) fn triangles(&self) -> usize {
        self.mesh.len()
    }

    pub(crate) fn into_mesh(self) -> Mesh {
        self.mesh
    }
}
