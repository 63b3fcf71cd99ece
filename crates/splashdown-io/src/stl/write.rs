//! The writer of the binary form.

use std::io::{self, Write};
use std::path::Path;

use crate::atomic;
use crate::data::{Mesh, cross, dot, sub};
use crate::error::IoError;

/// The free text of the header; it must not begin with `solid`, which would look like the text form.
const TITLE: &[u8] = b"written by Splashdown; metres, y is up";
/// Triangles gathered before each write.
const CHUNK: usize = 1024;

/// Writes a mesh to `path`, complete or not at all; returns the file's size in bytes.
///
/// # Errors
/// Those of [`Mesh::check`]; [`IoError::Write`].
pub fn write_mesh(path: &Path, mesh: &Mesh) -> Result<u64, IoError> {
    mesh.check()?;
    atomic::write(path, |out| write_mesh_to(out, mesh))
}

/// Writes a mesh that passes [`Mesh::check`] into any writer, with the normal of each triangle (zero where it has no
/// area).
///
/// # Errors
/// The writer's own; `InvalidInput` where the check fails.
pub fn write_mesh_to(out: &mut dyn Write, mesh: &Mesh) -> io::Result<()> {
    mesh.check().map_err(|error| io::Error::new(io::ErrorKind::InvalidInput, error))?;
    let mut header = [0; 80];
    header[..TITLE.len()].copy_from_slice(TITLE);
    out.write_all(&header)?;
    // The check bounds the count by 2^31.
    out.write_all(&(mesh.len() as u32).to_le_bytes())?;
    let mut buffer = Vec::with_capacity(50 * CHUNK);
    for chunk in mesh.triangles.chunks(CHUNK) {
        buffer.clear();
        for triangle in chunk {
            let corners = triangle.map(|index| mesh.vertices[index as usize]);
            let [a, b, c] = corners.map(|corner| corner.map(f64::from));
            let normal = cross(sub(b, a), sub(c, a));
            let length = dot(normal, normal).sqrt();
            let unit = normal.map(|n| if length > 0.0 { (n / length) as f32 } else { 0.0 });
            buffer.extend_from_slice(bytemuck::bytes_of(&unit));
            buffer.extend_from_slice(bytemuck::bytes_of(&corners));
            buffer.extend_from_slice(&[0; 2]);
        }
        out.write_all(&buffer)?;
    }
    Ok(())
}
