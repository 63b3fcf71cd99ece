//! The writers of binary files: a grid of points, or a surface of triangles.
//!
//! Particles are of the kind `UNSTRUCTURED_GRID`, which `meshio` and `splashsurf` read, and meshes of the kind `POLYDATA`,
//! which the filters of VTK for surfaces require.

use std::io::{self, Write};

use crate::data::{Attribute, Mesh, ParticleInfo, Particles};

/// Numbers converted to big-endian before each write.
const CHUNK: usize = 8192;

/// `VTK_VERTEX` among VTK's cell types.
const VTK_VERTEX: u32 = 1;

/// Writes particles to `out`. Each particle is a cell, as in a VTU file; attributes that are present become the point
/// arrays `velocity`, `density`, `pressure` and `id`, other attributes those of their names. Time and particle spacing
/// are the arrays `TimeValue` and `particle_spacing` of the field data.
///
/// # Errors
/// Those of `out`; `InvalidInput` if [`Particles::check`] fails.
pub fn write_particles_to(out: &mut dyn Write, particles: &Particles) -> io::Result<()> {
    particles.check()?;
    let count = particles.len();
    begin(out, "UNSTRUCTURED_GRID")?;
    field(out, particles.info)?;
    points(out, &particles.positions)?;
    cells(out, "CELLS", count, 1, (0..count as u32).flat_map(|point| [1, point]))?;
    writeln!(out, "CELL_TYPES {count}")?;
    words(out, std::iter::repeat_n(VTK_VERTEX, count))?;
    writeln!(out, "POINT_DATA {count}")?;
    if particles.has(particles.velocities.len()) {
        vectors(out, "VECTORS velocity", &particles.velocities)?;
    }
    for (what, values) in [
        ("density float", bytemuck::cast_slice(&particles.densities)),
        ("pressure float", bytemuck::cast_slice(&particles.pressures)),
        ("id unsigned_int", &particles.ids[..]),
    ] {
        if particles.has(values.len()) {
            scalars(out, what, values)?;
        }
    }
    particles.other_attributes().try_for_each(|attribute| array(out, attribute))
}

/// Writes a mesh to `out`. Normals and velocities that are present become the point arrays `normals` and `velocity`,
/// other attributes those of their names.
///
/// # Errors
/// Those of `out`; `InvalidInput` if [`Mesh::check`] fails.
pub fn write_mesh_to(out: &mut dyn Write, mesh: &Mesh) -> io::Result<()> {
    mesh.check()?;
    begin(out, "POLYDATA")?;
    points(out, &mesh.vertices)?;
    cells(out, "POLYGONS", mesh.len(), 3, mesh.triangles.iter().flat_map(|&[a, b, c]| [3, a, b, c]))?;
    writeln!(out, "POINT_DATA {}", mesh.vertices.len())?;
    for (what, values) in [("NORMALS normals", &mesh.normals), ("VECTORS velocity", &mesh.velocities)] {
        if !values.is_empty() {
            vectors(out, what, values)?;
        }
    }
    mesh.attributes.iter().try_for_each(|attribute| array(out, attribute))
}

fn begin(out: &mut dyn Write, kind: &str) -> io::Result<()> {
    writeln!(
        out,
        "# vtk DataFile Version 3.0\nwritten by Splashdown; SI units, y is up\nBINARY\nDATASET {kind}"
    )
}

/// Writes time and particle spacing.
fn field(out: &mut dyn Write, info: ParticleInfo) -> io::Result<()> {
    let fields = info.fields();
    if !fields.is_empty() {
        writeln!(out, "FIELD FieldData {}", fields.len())?;
    }
    for (name, value) in fields {
        writeln!(out, "{name} 1 1 double")?;
        out.write_all(&value.to_be_bytes())?;
        writeln!(out)?;
    }
    Ok(())
}

fn points(out: &mut dyn Write, points: &[[f32; 3]]) -> io::Result<()> {
    writeln!(out, "POINTS {} float", points.len())?;
    words(out, bytemuck::cast_slice::<_, u32>(points).iter().copied())
}

/// Writes cells, each as its number of points and the points.
fn cells(
    out: &mut dyn Write,
    keyword: &str,
    count: usize,
    corners: usize,
    list: impl Iterator<Item = u32>,
) -> io::Result<()> {
    writeln!(out, "{keyword} {count} {}", count * (corners + 1))?;
    words(out, list)
}

/// Writes an attribute as a point array of its name.
fn array(out: &mut dyn Write, attribute: &Attribute) -> io::Result<()> {
    let name = attribute.word();
    match attribute.values.as_chunks() {
        (values, []) if attribute.components == 3 => vectors(out, &format!("VECTORS {name}"), values),
        _ => scalars(out, &format!("{name} float"), bytemuck::cast_slice(&attribute.values)),
    }
}

fn vectors(out: &mut dyn Write, what: &str, values: &[[f32; 3]]) -> io::Result<()> {
    writeln!(out, "{what} float")?;
    words(out, bytemuck::cast_slice::<_, u32>(values).iter().copied())
}

fn scalars(out: &mut dyn Write, what: &str, values: &[u32]) -> io::Result<()> {
    writeln!(out, "SCALARS {what} 1\nLOOKUP_TABLE default")?;
    words(out, values.iter().copied())
}

/// Writes big-endian words and a line feed.
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
