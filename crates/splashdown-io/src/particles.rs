//! Writing particles in the format of their file name.

use std::path::Path;

use crate::data::Particles;
use crate::error::IoError;
use crate::format::{self, Format};

/// Writes particles in the format of the file name's ending ([`Format`]). The file is complete or absent. Returns its
/// size in bytes.
///
/// # Errors
/// [`IoError::UnknownFormat`], the errors of [`Particles::check`], or [`IoError::Write`].
pub fn write_particles(path: &Path, particles: &Particles) -> Result<u64, IoError> {
    match Format::of(path).and_then(|format| format.write_particles) {
        Some(write) => write(path, particles),
        None => Err(format::unknown(path, |format| format.write_particles.is_some())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn three() -> Particles {
        Particles::from_positions(vec![[0.0; 3]; 3]).with_ids(vec![0, 1, 2])
    }

    #[test]
    fn an_unknown_ending_lists_the_known_ones() {
        let message = write_particles(Path::new("frame.xyz"), &three()).unwrap_err().to_string();
        assert!(
            message.contains("frame.xyz") && message.contains(".ply, .vtk, .vtu, .vtp, .bgeo, .npz"),
            "{message}"
        );
    }
}
