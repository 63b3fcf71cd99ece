//! The writer of binary files.

use std::io::{self, Write};

use crate::data::{Mesh, cross, dot, sub};

/// The free text of the header. It must not begin with `solid`, as text files do.
const TITLE: &[u8] = b"written by Splashdown; metres, y is up";
/// Triangles per write.
const CHUNK: usize = 1024;

/// Writes a mesh to `out`, with the normal of each triangle (zero if it has no area).
///
/// # Errors
/// Those of `out`; `InvalidInput` if [`Mesh::check`] fails.
pub fn write_mesh_to(out: &mut dyn Write, mesh: &Mesh) -> io::Result<()> {
    mesh.check()?;
    let mut header = [0; 80];
    header[..TITLE.len()].copy_from_slice(TITLE);
    out.write_all(&header)?;
    // `check` limits the number of triangles to 2^31.
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
