//! PVD, ParaView's index of a series: the time of each file.
//!
//! Opening the `.pvd` file shows the series with its times in seconds. The format is a few lines of XML described in
//! ParaView's wiki; there is no crate for it.

use std::path::Path;

use crate::atomic;
use crate::error::IoError;

/// Writes the index of a series to `path`; returns the file's size in bytes.
///
/// Each entry is the time in s and the file's path relative to the index, with `/` between folders. The index can be
/// written after every frame, so that an unfinished series can be opened.
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

/// Escapes the characters that are not allowed in an XML attribute.
fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
