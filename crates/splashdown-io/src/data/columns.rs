//! The meaning of the arrays in particle files, shared by the readers.

use super::{Attribute, Particles};
use crate::number::whole;

/// The arrays that have a field in [`Particles`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Column {
    Velocity,
    Density,
    Pressure,
    Id,
}

impl Column {
    /// The meaning of an array with this name, in any case, and this number of components.
    pub(crate) fn named(name: &str, components: usize) -> Option<Self> {
        let column = match name.to_ascii_lowercase().as_str() {
            "velocity" | "velocities" | "vel" | "v" | "u" => Self::Velocity,
            "density" | "densities" | "rho" => Self::Density,
            "pressure" | "pressures" | "p" => Self::Pressure,
            "id" | "ids" | "particle_id" | "particleid" => Self::Id,
            _ => return None,
        };
        (components == if column == Self::Velocity { 3 } else { 1 }).then_some(column)
    }

    /// Appends values to the field.
    pub(crate) fn append(self, particles: &mut Particles, values: &[f64]) -> Result<(), String> {
        let floats = || values.iter().map(|&value| value as f32);
        match self {
            Self::Velocity => particles.velocities.extend(triples(values)),
            Self::Density => particles.densities.extend(floats()),
            Self::Pressure => particles.pressures.extend(floats()),
            Self::Id => {
                for &value in values {
                    particles.ids.push(
                        whole(value).ok_or_else(|| {
                            format!("the id {value} is not an integer from 0 to {}", u32::MAX)
                        })?,
                    );
                }
            }
        }
        Ok(())
    }
}

/// Which arrays of a file are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wanted {
    /// Those that have a field in [`Particles`].
    Known,
    /// All; they are also stored as attributes.
    All,
}

impl Wanted {
    /// Whether an array is read.
    pub(crate) fn has(self, name: &str, components: usize) -> bool {
        Column::named(name, components).is_some() || self == Self::All && matches!(components, 1 | 3)
    }

    /// Appends values to the field and the attribute that they belong to.
    pub(crate) fn append(
        self,
        particles: &mut Particles,
        name: &str,
        components: usize,
        values: &[f64],
    ) -> Result<(), String> {
        if let Some(column) = Column::named(name, components) {
            column.append(particles, values)?;
        }
        if self == Self::All && matches!(components, 1 | 3) {
            let known = particles.attributes.iter().position(|attribute| attribute.name == name);
            let index = known.unwrap_or_else(|| {
                let name = name.to_owned();
                particles.attributes.push(Attribute { name, components, values: Vec::new() });
                particles.attributes.len() - 1
            });
            particles.attributes[index].values.extend(values.iter().map(|&value| value as f32));
        }
        Ok(())
    }
}

/// Vectors from three adjacent numbers each.
pub(crate) fn triples(values: &[f64]) -> impl Iterator<Item = [f32; 3]> + '_ {
    values.chunks_exact(3).map(|row| [row[0] as f32, row[1] as f32, row[2] as f32])
}
