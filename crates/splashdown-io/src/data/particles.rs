//! Particles on the host, as plain arrays.

use super::attribute::Attribute;
use crate::error::IoError;

/// A set of particles, one array per attribute, in the order of the solver's choosing (ids tell them apart).
///
/// Every array but `positions` may be empty, which means that the attribute is absent; otherwise it is as long as
/// `positions` ([`Particles::check`]). Values are written as they are, NaN included: a file that hid them would
/// hide the very thing one looks for.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Particles {
    /// Stable number of each particle, the same in every frame.
    pub ids: Vec<u32>,
    /// Positions in m; y is up.
    pub positions: Vec<[f32; 3]>,
    /// Velocities in m/s.
    pub velocities: Vec<[f32; 3]>,
    /// Densities in kg/m^3.
    pub densities: Vec<f32>,
    /// Pressures in Pa.
    pub pressures: Vec<f32>,
    /// Everything that a file has for each particle, where it was asked for ([`read_all`](crate::read_all)).
    /// The writers pass over it.
    pub attributes: Vec<Attribute>,
}

impl Particles {
    /// Number of particles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Tells whether every attribute is absent or as long as `positions`, and whether a file can count them.
    ///
    /// # Errors
    /// [`IoError::Length`] names the first attribute that does not fit; [`IoError::TooMany`] beyond 2^31 - 1 particles.
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

/// The formats number things with signed 32-bit integers.
pub(crate) fn check_count(what: &'static str, given: usize) -> Result<(), IoError> {
    let limit = i32::MAX as usize;
    if given <= limit { Ok(()) } else { Err(IoError::TooMany { what, given, limit }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn three() -> Particles {
        Particles { positions: vec![[0.0; 3]; 3], ids: vec![0, 1, 2], ..Particles::default() }
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
            ("ids", Particles { ids: vec![1], ..three() }),
            ("velocities", Particles { velocities: vec![[0.0; 3]; 4], ..three() }),
            ("densities", Particles { densities: vec![0.0; 2], ..three() }),
            ("pressures", Particles { pressures: vec![0.0; 1], ..three() }),
        ];
        for (name, particles) in wrong {
            let message = particles.check().unwrap_err().to_string();
            assert!(message.contains(name) && message.contains("3 particles"), "{message}");
        }
    }
}
