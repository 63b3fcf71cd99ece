//! Particles in host memory, as plain arrays.

use super::columns::Column;
use super::{Attribute, ParticleInfo};
use crate::error::IoError;

/// A set of particles, one array per attribute. The order of the particles is arbitrary; `ids` identify them.
///
/// An array other than `positions` is either empty, which means that the attribute is absent, or as long as `positions`
/// ([`Particles::check`]). Values are written unchanged, NaN included, so that a file shows what went wrong.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Particles {
    /// Number of each particle, the same in every frame.
    pub ids: Vec<u32>,
    /// Positions in m; y is up.
    pub positions: Vec<[f32; 3]>,
    /// Velocities in m/s.
    pub velocities: Vec<[f32; 3]>,
    /// Densities in kg/m^3.
    pub densities: Vec<f32>,
    /// Pressures in Pa.
    pub pressures: Vec<f32>,
    /// All attributes of a file, as read by
    /// [`read_particles_with_attributes`](crate::read_particles_with_attributes). PLY, VTK, VTU, BGEO and NPZ files
    /// store those that have no field above.
    pub attributes: Vec<Attribute>,
    /// Time and particle spacing, where they are known.
    pub info: ParticleInfo,
}

impl Particles {
    /// Particles at these positions in m, without any other attribute.
    #[must_use]
    pub fn from_positions(positions: Vec<[f32; 3]>) -> Self {
        Self { positions, ..Self::default() }
    }

    /// Sets the ids.
    #[must_use]
    pub fn with_ids(self, ids: Vec<u32>) -> Self {
        Self { ids, ..self }
    }

    /// Sets the velocities, in m/s.
    #[must_use]
    pub fn with_velocities(self, velocities: Vec<[f32; 3]>) -> Self {
        Self { velocities, ..self }
    }

    /// Sets the densities, in kg/m^3.
    #[must_use]
    pub fn with_densities(self, densities: Vec<f32>) -> Self {
        Self { densities, ..self }
    }

    /// Sets the pressures, in Pa.
    #[must_use]
    pub fn with_pressures(self, pressures: Vec<f32>) -> Self {
        Self { pressures, ..self }
    }

    /// Sets the other attributes.
    #[must_use]
    pub fn with_attributes(self, attributes: Vec<Attribute>) -> Self {
        Self { attributes, ..self }
    }

    /// Sets the time and the particle spacing.
    #[must_use]
    pub fn with_info(self, info: ParticleInfo) -> Self {
        Self { info, ..self }
    }

    /// Whether files store an attribute with this many values. Without particles an empty array does not mean that the
    /// attribute is unknown, and a series of files has the same arrays in all.
    pub(crate) fn has(&self, values: usize) -> bool {
        self.is_empty() || values > 0
    }

    /// The attributes without a field, which files store under their names.
    pub(crate) fn other_attributes(&self) -> impl Iterator<Item = &Attribute> {
        let has_field =
            |attribute: &Attribute| Column::named(&attribute.name, attribute.components).is_some();
        self.attributes.iter().filter(move |attribute| !has_field(attribute))
    }

    /// Number of particles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there are no particles.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Checks that every attribute is absent or as long as `positions`, and that the formats can count the particles.
    ///
    /// # Errors
    /// [`IoError::Length`] names the first attribute of another length; [`IoError::TooMany`] beyond 2^31 - 1 particles.
    pub fn check(&self) -> Result<(), IoError> {
        let expected = self.len();
        let lengths = [
            ("ids", self.ids.len()),
            ("velocities", self.velocities.len()),
            ("densities", self.densities.len()),
            ("pressures", self.pressures.len()),
        ];
        for (attribute, given) in lengths {
            if given != 0 && given != expected {
                let attribute = attribute.to_owned();
                return Err(IoError::Length { attribute, given, expected, owner: "particles" });
            }
        }
        self.attributes.iter().try_for_each(|attribute| attribute.check(expected, "particles"))?;
        check_count("particles", expected)
    }
}

/// The formats count with signed 32-bit integers.
pub(crate) fn check_count(what: &'static str, given: usize) -> Result<(), IoError> {
    let limit = i32::MAX as usize;
    if given <= limit { Ok(()) } else { Err(IoError::TooMany { what, given, limit }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn three() -> Particles {
        Particles::from_positions(vec![[0.0; 3]; 3]).with_ids(vec![0, 1, 2])
    }

    #[test]
    fn absent_and_complete_attributes_pass() {
        assert_eq!(three().check(), Ok(()));
        assert_eq!(Particles::default().check(), Ok(()));
        assert!(Particles::default().is_empty());
        assert_eq!(three().len(), 3);
    }

    #[test]
    fn every_attribute_of_wrong_length_is_named() {
        let wrong = [
            ("ids", three().with_ids(vec![1])),
            ("velocities", three().with_velocities(vec![[0.0; 3]; 4])),
            ("densities", three().with_densities(vec![0.0; 2])),
            ("pressures", three().with_pressures(vec![0.0; 1])),
        ];
        for (name, particles) in wrong {
            let message = particles.check().unwrap_err().to_string();
            assert!(message.contains(name) && message.contains("3 particles"), "{message}");
        }
    }
}
