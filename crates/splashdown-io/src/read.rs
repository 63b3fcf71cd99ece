//! Reading any mesh or particle file by the ending of its name.

use std::path::Path;

use crate::data::columns::Wanted;
use crate::data::{Mesh, Particles};
use crate::error::IoError;
use crate::input::{MOST, extension, regular};
use crate::{bgeo, gltf, npy, npz, obj, ply, stl, vtk, vtu, xyz};

/// File name endings that [`read_mesh`] understands.
pub const MESH_FORMATS_READ: &[&str] = &[".obj", ".stl", ".ply", ".gltf", ".glb"];

/// File name endings that [`read_particles`] understands.
pub const PARTICLE_FORMATS_READ: &[&str] = &[".ply", ".npy", ".npz", ".vtk", ".vtu", ".vtp", ".bgeo", ".xyz"];

/// The readers of one format.
type MeshReader = fn(&Path) -> Result<Mesh, IoError>;
type ParticleReader = fn(&Path, Wanted) -> Result<Particles, IoError>;

/// Reads a triangle mesh in the format that the name's ending tells ([`MESH_FORMATS_READ`]).
///
/// Coordinates come back as they stand in the file, without any unit or up-axis applied. Polygons are cut into fans
/// of triangles and normals are dropped: what a solid is made of are its triangles. Corners at the same place become
/// one vertex in formats that keep none in common (STL) or cut them apart for their textures (glTF). A mesh that is
/// returned has at least one triangle, its vertices are finite and its indices in range; whether it is closed is told
/// by [`Mesh::topology`].
///
/// # Errors
/// [`IoError::UnknownFormat`] lists the endings; [`IoError::Read`] where the file cannot be read;
/// [`IoError::Malformed`] where it is broken, cut short, without triangles or with coordinates that are not finite;
/// [`IoError::TooMany`].
pub fn read_mesh(path: &Path) -> Result<Mesh, IoError> {
    let (format, read): (_, MeshReader) = match extension(path).as_deref() {
        Some("obj") => ("OBJ", obj::read_mesh),
        Some("stl") => ("STL", stl::read_mesh),
        Some("ply") => ("PLY", ply::read_mesh),
        Some("gltf" | "glb") => ("glTF", gltf::read_mesh),
        _ => return Err(IoError::UnknownFormat { path: path.to_owned(), allowed: MESH_FORMATS_READ }),
    };
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

/// Reads particles in the format that the name's ending tells ([`PARTICLE_FORMATS_READ`]; `.bgeo.gz` too).
///
/// There is at least one particle, and positions and velocities are finite; velocities, densities, pressures and ids
/// are there if the file has them (NPY and XYZ files have positions only).
///
/// # Errors
/// [`IoError::UnknownFormat`] lists the endings; [`IoError::Read`] where the file cannot be read;
/// [`IoError::Malformed`] where it is broken, cut short, empty, or holds numbers that are not finite;
/// [`IoError::TooMany`].
pub fn read_particles(path: &Path) -> Result<Particles, IoError> {
    read(path, Wanted::Known)
}

/// As [`read_particles`], with everything that the file has for each particle in [`Particles::attributes`],
/// velocities and densities too, by their names in the file: one number or three of whatever type. Properties
/// `a_x a_y a_z` of a PLY file are one vector `a`, and `vx vy vz` is `velocity`.
///
/// # Errors
/// As [`read_particles`].
pub fn read_all(path: &Path) -> Result<Particles, IoError> {
    read(path, Wanted::All)
}

fn read(path: &Path, wanted: Wanted) -> Result<Particles, IoError> {
    let ending = match extension(path).as_deref() {
        // Of two endings the first tells what is inside.
        Some("gz") => extension(&path.with_extension("")).filter(|inner| inner == "bgeo"),
        _ => extension(path),
    };
    let (format, read): (_, ParticleReader) = match ending.as_deref() {
        Some("ply") => ("PLY", ply::read),
        Some("npy") => {
            ("NPY", |path, _| Ok(Particles { positions: npy::read_positions(path)?, ..Particles::default() }))
        }
        Some("vtk") => ("VTK", vtk::read),
        Some("vtu" | "vtp") => ("VTU", vtu::read),
        Some("bgeo") => ("BGEO", bgeo::read),
        Some("npz") => ("NPZ", npz::read),
        Some("xyz") => ("XYZ", |path, _| xyz::read_particles(path)),
        _ => return Err(IoError::UnknownFormat { path: path.to_owned(), allowed: PARTICLE_FORMATS_READ }),
    };
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

/// Whether there is a triangle and every vertex is a place.
fn usable(mesh: &Mesh) -> Result<(), String> {
    let vertices = mesh.vertices.len();
    if mesh.is_empty() {
        return Err(format!("it has no triangles ({vertices} vertices, no faces): a mesh needs some"));
    }
    finite("vertices", &mesh.vertices)
}

/// Whether every vector has finite components.
fn finite(what: &str, vectors: &[[f32; 3]]) -> Result<(), String> {
    let is_bad = |vector: &[f32; 3]| !vector.iter().all(|component| component.is_finite());
    let Some(first) = vectors.iter().position(is_bad) else { return Ok(()) };
    let (bad, all) = (vectors.iter().filter(|vector| is_bad(vector)).count(), vectors.len());
    let [x, y, z] = vectors[first];
    Err(format!(
        "{bad} of its {all} {what} are not finite, the first is number {first} (from 0): ({x}, {y}, {z})"
    ))
}
