//! The writer, of the binary form: one grid of points, or of triangles.
//!
//! Both are of the kind `UNSTRUCTURED_GRID`, which more programs read than `POLYDATA` (`meshio`, `splashsurf`).

use std::io::{self, Write};
use std::path::Path;

use crate::atomic;
use crate::data::Mesh;
use crate::data::Particles;
use crate::error::IoError;

/// Numbers turned round and gathered before each write.
const CHUNK: usize = 8192;

/// Kinds of cells in VTK's list.
const VTK_VERTEX: u32 = 1;
const VTK_TRIANGLE: u32 = 5;

/// Writes particles to `path`, complete or not at all; returns the file's size in bytes.
///
/// Each particle is a cell, as in a VTU file; attributes that are present become the point arrays `velocity`,
/// `density`, `pressure` and `id`.
///
/// # Errors
/// Those of [`Particles::check`]; [`IoError::Write`].
pub fn write_particles(path: &Path, particles: &Particles) -> Result<u64, IoError> {
    particles.check()?;
    atomic::write(path, |out| write_particles_to(out, particles))
}

/// Writes a mesh to `path`, complete or not at all; returns the file's size in bytes. Normals and velocities that are
/// present become the point arrays `normals` and `velocity`, attributes those of their names.
///
/// # Errors
/// Those of [`Mesh::check`]; [`IoError::Write`].
pub fn write_mesh(path: &Path, mesh: &Mesh) -> Result<u64, IoError> {
    mesh.check()?;
    atomic::write(path, |out| write_mesh_to(out, mesh))
}

/// Writes particles that pass [`Particles::check`] into any writer.
///
/// # Errors
/// The writer's own; `InvalidInput` where the check fails.
pub fn write_particles_to(out: &mut dyn Write, particles: &Particles) -> io::Result<()> {
    particles.check().map_err(invalid)?;
    let count = particles.len();
    begin(out, &particles.positions)?;
    cells(out, count, 1, VTK_VERTEX, (0..count as u32).flat_map(|point| [1, point]))?;
    writeln!(out, "POINT_DATA {count}")?;
    vectors(out, "VECTORS velocity", &particles.velocities)?;
    scalars(out, "density float", bytemuck::cast_slice(&particles.densities))?;
    scalars(out, "pressure float", bytemuck::cast_slice(&particles.pressures))?;
    scalars(out, "id unsigned_int", &particles.ids)
}

/// Writes a mesh that passes [`Mesh::check`] into any writer.
///
/// # Errors
/// The writer's own; `InvalidInput` where the check fails.
pub fn write_mesh_to(out: &mut dyn Write, mesh: &Mesh) -> io::Result<()> {
    mesh.check().map_err(invalid)?;
    begin(out, &mesh.vertices)?;
    cells(out, mesh.len(), 3, VTK_TRIANGLE, mesh.triangles.iter().flat_map(|&[a, b, c]| [3, a, b, c]))?;
    writeln!(out, "POINT_DATA {}", mesh.vertices.len())?;
    // Not `NORMALS`, at which `meshio` gives up.
    vectors(out, "VECTORS normals", &mesh.normals)?;
    vectors(out, "VECTORS velocity", &mesh.velocities)?;
    for attribute in &mesh.attributes {
        let name = attribute.word();
        match attribute.values.as_chunks() {
            (values, []) if attribute.components == 3 => vectors(out, &format!("VECTORS {name}"), values)?,
            _ => scalars(out, &format!("{name} float"), bytemuck::cast_slice(&attribute.values))?,
        }
    }
    Ok(())
}

fn invalid(error: IoError) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, error)
}

fn begin(out: &mut dyn Write, points: &[[f32; 3]]) -> io::Result<()> {
    writeln!(out, "# vtk DataFile Version 3.0\nwritten by Splashdown; SI units, y is up\nBINARY")?;
    writeln!(out, "DATASET UNSTRUCTURED_GRID\nPOINTS {} float", points.len())?;
    words(out, bytemuck::cast_slice::<_, u32>(points).iter().copied())
}

/// The cells, each its number of corners and the corners, and what they are.
fn cells(
    out: &mut dyn Write,
    count: usize,
    corners: usize,
    kind: u32,
    list: impl Iterator<Item = u32>,
) -> io::Result<()> {
    writeln!(out, "CELLS {count} {}", count * (corners + 1))?;
    words(out, list)?;
    writeln!(out, "CELL_TYPES {count}")?;
    words(out, std::iter::repeat_n(kind, count))
}

fn vectors(out: &mut dyn Write, what: &str, values: &[[f32; 3]]) -> io::Result<()> {
    if values.is_empty() {
        return Ok(());
    }
    writeln!(out, "{what} float")?;
    words(out, bytemuck::cast_slice::<_, u32>(values).iter().copied())
}

fn scalars(out: &mut dyn Write, what: &str, values: &[u32]) -> io::Result<()> {
    if values.is_empty() {
        return Ok(());
    }
    writeln!(out, "SCALARS {what} 1\nLOOKUP_TABLE default")?;
    words(out, values.iter().copied())
}

/// Words with their highest byte first, as the format has them, and a line's end.
fn words(out: &mut dyn Write, mut words: impl Iterator<Item = u32>) -> io::Result<()> {
    let mut buffer = Vec::with_capacity(4 * CHUNK);
    loop {
        buffer.clear();
        buffer.extend(words.by_ref().take(CHUNK).flat_map(u32::to_be_bytes));
        if buffer.is_empty() {
            return out.write_all(b"\n");
        }
        out.write_all(&buffer)?;
    }
}
