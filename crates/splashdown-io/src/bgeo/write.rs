//! The writer. Files are not compressed, because compression takes longer than writing.

use std::borrow::Cow;
use std::io::{self, Write};

use crate::data::info::{PARTICLE_SPACING, TIME};
use crate::data::{ParticleInfo, Particles};

/// Points per write.
const ROWS: usize = 2048;

/// Characters of an attribute's name, whose bytes are counted in 16 bits.
const LONGEST_NAME: usize = 1000;

/// An attribute as described in the header, with its data.
struct Attribute<'a> {
    name: Cow<'static, str>,
    /// 0: float, 1: integer, 5: vector.
    kind: i32,
    components: usize,
    words: &'a [u32],
}

/// Writes particles to `out`. Attributes that are present become `v` (Houdini's name of the velocity, used for motion
/// blur), `density`, `pressure` and `id`; other attributes keep their names. `time` and `particle_spacing` are attributes
/// of the whole.
///
/// # Errors
/// Those of `out`; `InvalidInput` if [`Particles::check`] fails.
pub fn write_particles_to(out: &mut dyn Write, particles: &Particles) -> io::Result<()> {
    particles.check()?;
    let attribute =
        |name, kind, components, words| Attribute { name: Cow::Borrowed(name), kind, components, words };
    let mut attributes = vec![
        attribute("v", 5, 3, bytemuck::cast_slice(&particles.velocities)),
        attribute("density", 0, 1, bytemuck::cast_slice(&particles.densities)),
        attribute("pressure", 0, 1, bytemuck::cast_slice(&particles.pressures)),
        attribute("id", 1, 1, bytemuck::cast_slice(&particles.ids)),
    ];
    attributes.retain(|attribute| particles.has(attribute.words.len()));
    attributes.extend(particles.other_attributes().map(|attribute| Attribute {
        name: Cow::Owned(attribute.word().chars().take(LONGEST_NAME).collect()),
        kind: if attribute.components == 3 { 5 } else { 0 },
        components: attribute.components,
        words: bytemuck::cast_slice(&attribute.values),
    }));

    let detail = detail(particles.info);
    out.write_all(b"BgeoV")?;
    // Version; points, primitives, groups of both; attributes of points, vertices, primitives and the whole.
    // The check has bounded the number of particles.
    for word in [5, particles.len() as i32, 0, 0, 0, attributes.len() as i32, 0, 0, detail.len() as i32] {
        out.write_all(&word.to_be_bytes())?;
    }
    for Attribute { name, kind, components, .. } in &attributes {
        describe(out, name, *kind, *components)?;
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
    for (name, _) in &detail {
        describe(out, name, 0, 1)?;
    }
    for (_, value) in &detail {
        out.write_all(&value.to_be_bytes())?;
    }
    // No extra data, then the end marker.
    out.write_all(&[0, 0xff])
}

/// Writes the description of an attribute.
fn describe(out: &mut dyn Write, name: &str, kind: i32, components: usize) -> io::Result<()> {
    out.write_all(&(name.len() as u16).to_be_bytes())?;
    out.write_all(name.as_bytes())?;
    out.write_all(&(components as u16).to_be_bytes())?;
    out.write_all(&kind.to_be_bytes())?;
    // The default value.
    out.write_all(&[0; 12][..4 * components])
}

/// Name and value of the attributes of the whole. The format has only single precision.
fn detail(info: ParticleInfo) -> Vec<(&'static str, f32)> {
    let ParticleInfo { time, particle_spacing } = info.credible();
    let time = time.map(|time| (TIME, time as f32));
    time.into_iter().chain(particle_spacing.map(|spacing| (PARTICLE_SPACING, spacing))).collect()
}
