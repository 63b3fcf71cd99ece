//! Writing a mesh in the format of its file name.

use std::path::Path;

use crate::data::Mesh;
use crate::error::IoError;
use crate::format::{self, Format};

/// Writes a mesh in the format of the file name's ending ([`Format`]). The file is complete or absent. Returns its size
/// in bytes.
///
/// # Errors
/// [`IoError::UnknownFormat`], the errors of [`Mesh::check`], [`IoError::TooMany`] beyond the 4 GiB of a glTF file, or
/// [`IoError::Write`].
pub fn write_mesh(path: &Path, mesh: &Mesh) -> Result<u64, IoError> {
    match Format::of(path).and_then(|format| format.write_mesh) {
        Some(write) => write(path, mesh),
        None => Err(format::unknown(path, |format| format.write_mesh.is_some())),
    }
}
