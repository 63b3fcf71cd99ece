//! Mapping of a particle quantity to colours.

use crate::{ColourMap, RenderError};

/// How a quantity is mapped to colours.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Colouring {
    /// The quantity.
    pub quantity: Quantity,
    /// Values at the two ends of the colour map, in the unit of the quantity. Values outside the
    /// range get the colour of the nearest end; equal ends are separated slightly.
    pub range: [f32; 2],
    /// The colour map.
    pub map: ColourMap,
    /// Whether the picture has a colour bar.
    pub colour_bar: bool,
}

/// A quantity that each particle has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Quantity {
    /// Magnitude of the velocity, m/s.
    Speed,
    /// Density, kg/m^3.
    Density,
    /// Pressure, Pa.
    Pressure,
}

impl Colouring {
    /// A quantity over a range, with the default colour map and a colour bar.
    pub fn new(quantity: Quantity, range: [f32; 2]) -> Colouring {
        Colouring { quantity, range, map: ColourMap::default(), colour_bar: true }
    }

    /// The same with another colour map.
    #[must_use]
    pub fn with_map(self, map: ColourMap) -> Colouring {
        Colouring { map, ..self }
    }

    /// The same with or without a colour bar.
    #[must_use]
    pub fn with_colour_bar(self, colour_bar: bool) -> Colouring {
        Colouring { colour_bar, ..self }
    }

    /// The ends of the range, separated from each other.
    pub(crate) fn checked_range(&self) -> Result<[f32; 2], RenderError> {
        let [low, high] = self.range;
        if !(low.is_finite() && high.is_finite() && low <= high) {
            return Err(RenderError::Value {
                what: "the range of the colour map",
                given: format!("{low} to {high}"),
                allowed: "two finite numbers, the smaller one first",
            });
        }
        // Smaller differences are lost in the rounding of the values themselves.
        let smallest = (1e-5 * low.abs().max(high.abs())).max(1e-6);
        Ok([low, high.max(low + smallest)])
    }
}

impl Quantity {
    /// The number of the quantity in `shared/quantity.wgsl`.
    pub(crate) fn index(self) -> u32 {
        match self {
            Quantity::Speed => 0,
            Quantity::Density => 1,
            Quantity::Pressure => 2,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_range_is_widened_and_an_invalid_one_is_refused() {
        let range = |low, high| Colouring::new(Quantity::Speed, [low, high]).checked_range();
        let [low, high] = range(0.0, 0.0).unwrap();
        assert!(low == 0.0 && high > 0.0);
        let [low, high] = range(1000.0, 1000.0).unwrap();
        assert!(low == 1000.0 && high > 1000.0);
        assert!(
            range(1.0, 0.0).is_err() && range(f32::NAN, 1.0).is_err() && range(0.0, f32::INFINITY).is_err()
        );
    }
}
