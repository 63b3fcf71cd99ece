//! Reads a mesh or particle file by the ending of its name.

use std::path::Path;

use crate::data::Mesh;
use crate::data::Particles;
use crate::data::columns::Wanted;
use crate::error::IoError;
use crate::format::{self, Format};
use crate::input::{MAX_COUNT, regular};

/// Reads a triangle mesh in the format of the file name's ending ([`Format`]).
///
/// Coordinates are those of the file, without any unit or up-axis applied. A polygon becomes a fan of triangles. Normals
/// are dropped, because a solid is defined by its triangles; velocities of a PLY file remain if
/// all are finite. Vertices at the same position are merged in formats that
/// do not share vertices (STL) or split them at texture seams (glTF). The returned mesh has at least one triangle, its
/// vertices are finite and its vertex numbers in range; [`Mesh::topology`] checks whether it is closed.
///
/// # Errors
/// [`IoError::UnknownFormat`] lists the endings; [`IoError::Read`] if the file cannot be read; [`IoError::Malformed`] if
/// it is damaged, cut short, without triangles or with coordinates that are not finite; [`IoError::TooMany`].
pub fn read_mesh(path: &Path) -> Result<Mesh, IoError> {
    let format = Format::of(path).and_then(|format| Some((format.name, format.read_mesh?)));
    let (format, read) = format.ok_or_else(|| format::unknown(path, Format::reads_meshes))?;
    regular(path)?;
    let mut mesh = read(path)?;
    mesh.normals.clear();
    if finite("velocities", &mesh.velocities).is_err() {
        mesh.velocities.clear();
    }
    usable(&mesh).map_err(|reason| IoError::malformed(path, format, reason))?;
    for (what, given) in [("vertices", mesh.vertices.len()), ("triangles", mesh.len())] {
        if given > MAX_COUNT {
            return Err(IoError::TooMany { what, given, limit: MAX_COUNT });
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
/// it is damaged, cut short, or contains numbers that are not finite; [`IoError::NoParticles`]; [`IoError::TooMany`].
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
    let (format, read) = format.ok_or_else(|| format::unknown(path, Format::reads_particles))?;
    regular(path)?;
    let mut particles = read(path, wanted)?;
    let count = particles.len();
    particles.attributes.retain(|attribute| attribute.check(count, "particles").is_ok());
    let malformed = |reason: String| IoError::malformed(path, format, reason);
    if particles.is_empty() {
        return Err(IoError::NoParticles { path: path.to_owned(), format });
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
