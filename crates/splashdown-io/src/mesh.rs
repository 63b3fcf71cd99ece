//! Writing a mesh in the format that the name of its file asks for.

use std::path::Path;

use crate::error::IoError;
use crate::input::extension;
use crate::{gltf, obj, ply, stl, vtk};

pub use crate::data::Mesh;

/// File name endings of the formats that hold [`Mesh::attributes`].
pub const WITH_ATTRIBUTES: &[&str] = &[".ply", ".vtk"];

/// File name endings that [`write()`] understands.
pub const FORMATS: &[&str] = &[".ply", ".obj", ".stl", ".vtk", ".glb"];

/// Writes a mesh in the format that the name's ending asks for ([`FORMATS`]); returns the file's size in bytes.
///
/// # Errors
/// [`IoError::UnknownFormat`], the errors of [`Mesh::check`], or [`IoError::Write`].
pub fn write(path: &Path, mesh: &Mesh) -> Result<u64, IoError> {
    match extension(path).as_deref() {
        Some("ply") => ply::write_mesh(path, mesh),
        Some("obj") => obj::write_mesh(path, mesh),
        Some("stl") => stl::write_mesh(path, mesh),
        Some("vtk") => vtk::write_mesh(path, mesh),
        Some("glb") => gltf::write_mesh(path, mesh),
        _ => Err(IoError::UnknownFormat { path: path.to_owned(), allowed: FORMATS }),
    }
}
