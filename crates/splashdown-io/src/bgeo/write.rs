//! The writer: unpacked, because packing takes longer than the disk.

use std::io::{self, Write};
use std::path::Path;

use crate::atomic;
use crate::data::Particles;
use crate::error::IoError;

/// Points gathered before each write.
const ROWS: usize = 2048;

/// An attribute as the header describes it, with the words of one point.
struct Attribute<'a> {
    name: &'static str,
    /// 0 is a number, 1 an integer, 5 a vector.
    kind: i32,
    components: usize,
    words: &'a [u32],
}

/// Writes particles to `path`, complete or not at all; returns the file's size in bytes.
///
/// Attributes that are present become `v` (Houdini's name of the velocity, by which it blurs motion),
/// `density`, `pressure` and `id`.
///
/// # Errors
/// Those of [`Particles::check`]; [`IoError::Write`].
pub fn write_particles(path: &Path, particles: &Particles) -> Result<u64, IoError> {
    particles.check()?;
    atomic::write(path, |out| write_particles_to(out, particles))
}

/// Writes particles that pass [`Particles::check`] into any writer.
///
/// # Errors
/// The writer's own; `InvalidInput` where the check fails.
pub fn write_particles_to(out: &mut dyn Write, particles: &Particles) -> io::Result<()> {
    particles.check().map_err(|error| io::Error::new(io::ErrorKind::InvalidInput, error))?;
    let attribute = |name, kind, components, words| Attribute { name, kind, components, words };
    let mut attributes = vec![
        attribute("v", 5, 3, bytemuck::cast_slice(&particles.velocities)),
        attribute("density", 0, 1, bytemuck::cast_slice(&particles.densities)),
        attribute("pressure", 0, 1, bytemuck::cast_slice(&particles.pressures)),
        attribute("id", 1, 1, bytemuck::cast_slice(&particles.ids)),
    ];
    attributes.retain(|attribute| !attribute.words.is_empty());

    out.write_all(b"BgeoV")?;
    // Version; points, primitives, groups of both; attributes of points, vertices, primitives and the whole.
    // The check has bounded the number of particles.
    for word in [5, particles.len() as i32, 0, 0, 0, attributes.len() as i32, 0, 0, 0] {
        out.write_all(&word.to_be_bytes())?;
    }
    for Attribute { name, kind, components, .. } in &attributes {
        out.write_all(&(name.len() as u16).to_be_bytes())?;
        out.write_all(name.as_bytes())?;
        out.write_all(&(*components as u16).to_be_bytes())?;
        out.write_all(&kind.to_be_bytes())?;
        // What a point has that has none.
        out.write_all(&[0; 12][..4 * components])?;
    }
    let mut buffer = Vec::with_capacity(ROWS * 4 * 10);
    for first in (0..particles.len()).step_by(ROWS) {
        buffer.clear();
        for point in first..(first + ROWS).min(particles.len()) {
            let [x, y, z] = particles.positions[point];
            buffer.extend([x, y, z, 1.0].into_iter().flat_map(f32::to_be_bytes));
            for Attribute { components, words, .. } in &attributes {
                let words = &words[point * components..(point + 1) * components];
                buffer.extend(words.iter().flat_map(|word| word.to_be_bytes()));
            }
        }
        out.write_all(&buffer)?;
    }
    // No more groups, and the end.
    out.write_all(&[0, 0xff])
}
