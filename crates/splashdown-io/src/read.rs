//! Reads a mesh or particle file by the ending of its name; also helpers of the readers.

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use crate::data::columns::Wanted;
use crate::data::{Mesh, Particles};
use crate::error::IoError;
use crate::format::Format;
use crate::mesh::Mesh;
use crate::particles::Particles;

/// The largest number of particles, or of triangles or vertices of a mesh, that is read: some gigabytes. A small glTF
/// file can refer to a large mesh many times, and must not use all memory.
pub(crate) const MOST: usize = 1 << 27;

/// Reads a triangle mesh in the format of the file name's ending ([`Format`]).
///
/// Coordinates are those of the file, without any unit or up-axis applied. A polygon becomes a fan of triangles. Normals
/// are dropped, because a solid is defined by its triangles. Vertices at the same position are merged in formats that
/// do not share vertices (STL) or split them at texture seams (glTF). The returned mesh has at least one triangle, its
/// vertices are finite and its vertex numbers in range; [`Mesh::topology`] checks whether it is closed.
///
/// # Errors
/// [`IoError::UnknownFormat`] lists the endings; [`IoError::Read`] if the file cannot be read; [`IoError::Malformed`] if
/// it is damaged, cut short, without triangles or with coordinates that are not finite; [`IoError::TooMany`].
pub fn read_mesh(path: &Path) -> Result<Mesh, IoError> {
    let format = Format::of(path).and_then(|format| Some((format.name, format.read_mesh?)));
    let (format, read) = format.ok_or_else(|| IoError::unknown_format(path, Format::reads_meshes))?;
    regular(path)?;
    let mut mesh = read(path)?;
    (mesh.normals, mesh.velocities) = (Vec::new(), Vec::new());
    usable(&mesh).map_err(|reason| IoError::malformed(path, format, reason))?;
    for (what, given) in [("vertices", mesh.vertices.len()), ("triangles", mesh.len())] {
        if given > MOST {
            return Err(IoError::TooMany { what, given, limit: MOST });
        }
    }
    mesh.check().map_err(|error| IoError::malformed(path, format, error.to_string()))?;
    Ok(mesh)
}

/// Reads particles in the format of the file name's ending ([`Format`]).
///
/// There is at least one particle, and positions and velocities are finite. Velocities, densities, pressures and ids are
/// read if the file has them. Their names, in any case, are `velocity` (`velocities`, `vel`, `v`, `u`), `density`
/// (`densities`, `rho`), `pressure` (`pressures`, `p`) and `id` (`ids`, `particle_id`); in a PLY file `vx vy vz`
/// (`velocity_x ..`, `u v w`), `density` (`rho`), `pressure` (`p`) and `id`. NPY and XYZ files have positions only.
///
/// # Errors
/// [`IoError::UnknownFormat`] lists the endings; [`IoError::Read`] if the file cannot be read; [`IoError::Malformed`] if
/// it is damaged, cut short, empty, or contains numbers that are not finite; [`IoError::TooMany`].
pub fn read_particles(path: &Path) -> Result<Particles, IoError> {
    read(path, Wanted::Known)
}

/// Like [`read_particles`], but also reads everything that the file has per particle into [`Particles::attributes`],
/// velocities and densities included, under their names in the file: scalars and vectors of any number type. Properties
/// `a_x a_y a_z` of a PLY file are the vector `a`, and `vx vy vz` are `velocity`.
///
/// # Errors
/// Those of [`read_particles`].
pub fn read_particles_with_attributes(path: &Path) -> Result<Particles, IoError> {
    read(path, Wanted::All)
}

fn read(path: &Path, wanted: Wanted) -> Result<Particles, IoError> {
    let format = Format::of(path).and_then(|format| Some((format.name, format.read_particles?)));
    let (format, read) = format.ok_or_else(|| IoError::unknown_format(path, Format::reads_particles))?;
    regular(path)?;
    let mut particles = read(path, wanted)?;
    let count = particles.len();
    particles.attributes.retain(|attribute| attribute.check(count, "particles").is_ok());
    let malformed = |reason: String| IoError::malformed(path, format, reason);
    if particles.is_empty() {
        return Err(malformed("it holds no particles".to_owned()));
    }
    particles.check().map_err(|error| malformed(error.to_string()))?;
    finite("positions", &particles.positions).map_err(malformed)?;
    finite("velocities", &particles.velocities).map_err(malformed)?;
    Ok(particles)
}

/// Checks that there is a triangle and that every vertex is finite.
fn usable(mesh: &Mesh) -> Result<(), String> {
    let vertices = mesh.vertices.len();
    if mesh.is_empty() {
        return Err(format!(
            "it has no triangles ({vertices} vertices, no faces): a mesh needs at least one"
        ));
    }
    finite("vertices", &mesh.vertices)
}

/// Checks that all components are finite.
fn finite(what: &str, vectors: &[[f32; 3]]) -> Result<(), String> {
    let is_bad = |vector: &[f32; 3]| !vector.iter().all(|component| component.is_finite());
    let Some(first) = vectors.iter().position(is_bad) else { return Ok(()) };
    let (bad, all) = (vectors.iter().filter(|vector| is_bad(vector)).count(), vectors.len());
    let [x, y, z] = vectors[first];
    Err(format!(
        "{bad} of its {all} {what} are not finite, the first is number {first} (from 0): ({x}, {y}, {z})"
    ))
}

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
    let what = if metadata.is_dir() { "it is a folder, not a file" } else { "it is not a regular file" };
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
        // Files have fewer than 2^32 corners: their counts were compared with their size or `MOST`.
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
