//! PVD, ParaView's index of a series: which file belongs to which time.
//!
//! Opening the one `.pvd` file shows the whole series with the right seconds on the time slider. The format is a few
//! lines of XML that ParaView's own wiki describes; there is no crate for it.

use std::path::Path;

use crate::atomic;
use crate::error::IoError;

/// Writes the index of a series to `path`; returns the file's size in bytes.
///
/// Each entry is the time in s and the file's name as seen from the index's own folder, with `/` between folders.
/// The whole index is written anew each time, so it may be written after every frame: the series can then be looked
/// at while it grows.
///
/// # Errors
/// [`IoError::Write`].
pub fn write_index(path: &Path, frames: &[(f64, String)]) -> Result<u64, IoError> {
    atomic::write(path, |out| {
        writeln!(
            out,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>"
        )?;
        for (time, file) in frames {
            writeln!(out, "<DataSet timestep=\"{time}\" group=\"\" part=\"0\" file=\"{}\"/>", escape(file))?;
        }
        writeln!(out, "</Collection>\n</VTKFile>")
    })
}

/// The characters that XML attributes cannot hold as they are.
fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
