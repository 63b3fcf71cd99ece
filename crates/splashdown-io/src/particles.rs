//! Writing particles in the format that the name of their file asks for.

use std::path::Path;

use crate::error::IoError;
use crate::input::extension;
use crate::{bgeo, npz, ply, vtk, vtu};

pub use crate::data::Particles;

/// File name endings that [`write()`] understands.
pub const FORMATS: &[&str] = &[".ply", ".vtk", ".vtu", ".bgeo", ".npz"];

/// Writes particles in the format that the name's ending asks for ([`FORMATS`]); returns the file's size in bytes.
///
/// # Errors
/// [`IoError::UnknownFormat`], the errors of [`Particles::check`], or [`IoError::Write`].
pub fn write(path: &Path, particles: &Particles) -> Result<u64, IoError> {
    match extension(path).as_deref() {
        Some("ply") => ply::write_particles(path, particles),
        Some("vtk") => vtk::write_particles(path, particles),
        Some("vtu") => vtu::write_particles(path, particles),
        Some("bgeo") => bgeo::write_particles(path, particles),
        Some("npz") => npz::write_particles(path, particles),
        _ => Err(IoError::UnknownFormat { path: path.to_owned(), allowed: FORMATS }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_ending_lists_the_known_ones() {
        let message = write(Path::new("frame.xyz"), &Particles::default()).unwrap_err().to_string();
        assert!(
            message.contains("frame.xyz") && message.contains(".ply, .vtk, .vtu, .bgeo, .npz"),
            "{message}"
        );
    }
}
