//! The floor of the scene.

use glam::Vec3;

use crate::RenderError;
use crate::globals::Globals;

/// The pattern of the floor. Its tiles have a round size: 1, 2 or 5 times a power of ten metres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FloorPattern {
    /// Slabs of slate with joints.
    Tiles,
    /// Light and dark squares.
    Checkerboard,
    /// One colour.
    Plain,
}

/// A horizontal floor below the domain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Floor {
    /// Its pattern.
    pub pattern: FloorPattern,
    /// The mean reflectance: linear red, green and blue, each from 0 to 1.
    pub colour: [f32; 3],
}

/// Reflectance that environment.wgsl multiplies by the tint.
const TONE: f32 = 0.07;
/// Tint of slate.
const SLATE: [f32; 3] = [0.97, 0.98, 1.0];

impl Default for Floor {
    fn default() -> Floor {
        Floor { pattern: FloorPattern::Tiles, colour: SLATE.map(|tint| tint * TONE) }
    }
}

impl Floor {
    /// The reflectance as a multiple of that of slate.
    pub(crate) fn relative(&self) -> Vec3 {
        Vec3::from(self.colour) / Vec3::from(Floor::default().colour)
    }

    /// Checks the values and writes the uniforms.
    pub(crate) fn fill(&self, globals: &mut Globals) -> Result<(), RenderError> {
        if !self.colour.iter().all(|part| (0.0..=1.0).contains(part)) {
            return Err(RenderError::Value {
                what: "the colour of the floor",
                given: format!("{:?}", self.colour),
                allowed: "three numbers from 0 to 1",
            });
        }
        // Exactly the tint of slate for its colour.
        globals.floor_tint = (self.relative() * Vec3::from(SLATE)).into();
        // As in environment.wgsl; 0 is no floor.
        globals.floor_pattern = match self.pattern {
            FloorPattern::Tiles => 1,
            FloorPattern::Checkerboard => 2,
            FloorPattern::Plain => 3,
        };
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_is_slate() {
        let mut globals = Globals::default();
        Floor::default().fill(&mut globals).unwrap();
        assert_eq!(globals.floor_tint, SLATE);
        assert_eq!(Floor::default().relative(), Vec3::ONE);
    }

    #[test]
    fn a_reflectance_above_one_is_refused() {
        let floor = Floor { colour: [0.5, 0.5, 1.1], ..Floor::default() };
        assert!(floor.fill(&mut Globals::default()).is_err());
    }
}
