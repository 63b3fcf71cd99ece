//! The writers: a header, then rows, through a small buffer.

use std::io::{self, Write};

use crate::data::info::{PARTICLE_SPACING, TIME};
use crate::data::{Attribute, Mesh, ParticleInfo, Particles};

/// Rows per write; the buffer fits into the cache.
const ROWS: usize = 2048;

/// Writes particles to `out`.
///
/// # Errors
/// Those of `out`; `InvalidInput` if [`Particles::check`] fails.
pub fn write_particles_to(out: &mut dyn Write, particles: &Particles) -> io::Result<()> {
    particles.check()?;
    let mut columns: Vec<(&[u8], usize, &str)> = vec![(bytes(&particles.positions), 12, "float x y z")];
    let optional = [
        (bytes(&particles.velocities), 12, "float vx vy vz"),
        (bytes(&particles.densities), 4, "float density"),
        (bytes(&particles.pressures), 4, "float pressure"),
        (bytes(&particles.ids), 4, "uint id"),
    ];
    columns.extend(optional.into_iter().filter(|column| particles.has(column.0.len())));
    let names: Vec<String> = particles.other_attributes().map(properties).collect();
    columns.extend(attribute_columns(particles.other_attributes(), &names));

    begin(out)?;
    comments(out, particles.info)?;
    element(out, "vertex", particles.len(), &columns)?;
    writeln!(out, "end_header")?;
    rows(out, particles.len(), &columns)
}

/// Writes a mesh to `out`.
///
/// # Errors
/// Those of `out`; `InvalidInput` if [`Mesh::check`] fails.
pub fn write_mesh_to(out: &mut dyn Write, mesh: &Mesh) -> io::Result<()> {
    mesh.check()?;
    let mut columns: Vec<(&[u8], usize, &str)> = vec![(bytes(&mesh.vertices), 12, "float x y z")];
    if !mesh.normals.is_empty() {
        columns.push((bytes(&mesh.normals), 12, "float nx ny nz"));
    }
    if !mesh.velocities.is_empty() {
        columns.push((bytes(&mesh.velocities), 12, "float vx vy vz"));
    }
    let names: Vec<String> = mesh.attributes.iter().map(properties).collect();
    columns.extend(attribute_columns(mesh.attributes.iter(), &names));

    begin(out)?;
    element(out, "vertex", mesh.vertices.len(), &columns)?;
    writeln!(out, "element face {}\nproperty list uchar int vertex_indices\nend_header", mesh.len())?;
    rows(out, mesh.vertices.len(), &columns)?;

    let mut buffer = Vec::with_capacity(ROWS * 13);
    for chunk in mesh.triangles.chunks(ROWS) {
        buffer.clear();
        for triangle in chunk {
            let mut row = [3; 13];
            row[1..].copy_from_slice(bytemuck::bytes_of(triangle));
            buffer.extend_from_slice(&row);
        }
        out.write_all(&buffer)?;
    }
    Ok(())
}

/// Type and names of an attribute's properties: a scalar is a property of its name, a vector `a` is `a_x a_y a_z`.
fn properties(attribute: &Attribute) -> String {
    let mut name = attribute.word();
    // The names of other properties.
    if ["x", "y", "z", "nx", "ny", "nz", "vx", "vy", "vz"].contains(&name.as_str()) {
        name.push('_');
    }
    match attribute.components {
        3 => format!("float {name}_x {name}_y {name}_z"),
        _ => format!("float {name}"),
    }
}

/// The columns of attributes with these types and names.
fn attribute_columns<'a>(
    attributes: impl Iterator<Item = &'a Attribute>,
    names: &'a [String],
) -> impl Iterator<Item = (&'a [u8], usize, &'a str)> {
    attributes
        .zip(names)
        .map(|(attribute, names)| (bytes(&attribute.values), 4 * attribute.components, names.as_str()))
}

fn bytes<T: bytemuck::NoUninit>(values: &[T]) -> &[u8] {
    bytemuck::cast_slice(values)
}

fn begin(out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "ply\nformat binary_little_endian 1.0\ncomment written by Splashdown; SI units, y is up")
}

/// Writes time and particle spacing, with the fewest digits from which the same numbers are read.
fn comments(out: &mut dyn Write, info: ParticleInfo) -> io::Result<()> {
    let ParticleInfo { time, particle_spacing } = info.credible();
    time.iter().try_for_each(|time| writeln!(out, "comment {TIME} {time}"))?;
    particle_spacing.iter().try_for_each(|spacing| writeln!(out, "comment {PARTICLE_SPACING} {spacing}"))
}

/// Writes the header lines of one element; a column is its bytes, its bytes per row, and its type and names.
fn element(
    out: &mut dyn Write,
    name: &str,
    count: usize,
    columns: &[(&[u8], usize, &str)],
) -> io::Result<()> {
    writeln!(out, "element {name} {count}")?;
    for (_, _, names) in columns {
        let mut words = names.split(' ');
        let kind = words.next().unwrap_or_default();
        for word in words {
            writeln!(out, "property {kind} {word}")?;
        }
    }
    Ok(())
}

/// Writes rows, each with one cell of all columns.
fn rows(out: &mut dyn Write, count: usize, columns: &[(&[u8], usize, &str)]) -> io::Result<()> {
    let mut buffer = Vec::with_capacity(ROWS * columns.iter().map(|column| column.1).sum::<usize>());
    for first in (0..count).step_by(ROWS) {
        buffer.clear();
        for row in first..(first + ROWS).min(count) {
            for &(data, size, _) in columns {
                buffer.extend_from_slice(&data[row * size..(row + 1) * size]);
            }
        }
        out.write_all(&buffer)?;
    }
    Ok(())
}
