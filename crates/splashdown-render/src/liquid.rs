//! Optical properties of liquids.

use crate::RenderError;
use crate::globals::Globals;

/// Optical properties of a liquid.
///
/// Real water is nearly colourless over one metre: it absorbs 30 % of red and almost none of blue
/// light (Pope and Fry 1997). Pictures of water usually exaggerate the tint, so the constructors
/// take the length `size` in metres over which the colour becomes visible, for example the height
/// or half the width of the box.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Liquid {
    /// Absorption coefficient for red, green and blue, 1/m (Beer-Lambert: `exp(-absorption *
    /// path)`).
    pub absorption: [f32; 3],
    /// Rate at which the liquid's own colour replaces the background, 1/m.
    pub scattering: f32,
    /// Smallest fraction of the liquid's own colour, in arbitrarily thin layers. Beer-Lambert gives
    /// 0; a larger value keeps drops and the edges of the tank visible, where internal reflection
    /// lengthens the real path.
    pub film: f32,
    /// The liquid's own colour at large depth, linear RGB.
    pub colour: [f32; 3],
    /// Refractive index, 1.333 for water.
    pub refractive_index: f32,
    /// Roughness of the surface for the highlight of the sun, from 0.02 (sharp) to 1 (diffuse).
    pub roughness: f32,
}

impl Liquid {
    /// Water: turquoise where it is shallow, blue where it is deep.
    pub fn water(size: f32) -> Liquid {
        Liquid::tinted(size, [2.80, 0.50, 0.20], 1.05, [0.006, 0.128, 0.260], 1.333)
    }

    /// Vegetable oil, pale gold.
    pub fn oil(size: f32) -> Liquid {
        Liquid::tinted(size, [0.10, 0.32, 1.90], 0.35, [0.42, 0.30, 0.03], 1.47)
    }

    /// Glycerin, almost colourless.
    pub fn glycerin(size: f32) -> Liquid {
        Liquid::tinted(size, [0.34, 0.26, 0.24], 0.18, [0.38, 0.44, 0.46], 1.473)
    }

    /// Honey, amber.
    pub fn honey(size: f32) -> Liquid {
        Liquid::tinted(size, [0.22, 1.25, 4.80], 0.90, [0.50, 0.175, 0.010], 1.49)
    }

    /// The liquid with a name: `water`, `oil`, `glycerin` or `honey`.
    pub fn from_name(name: &str, size: f32) -> Option<Liquid> {
        match name {
            "water" => Some(Liquid::water(size)),
            "oil" => Some(Liquid::oil(size)),
            "glycerin" => Some(Liquid::glycerin(size)),
            "honey" => Some(Liquid::honey(size)),
            _ => None,
        }
    }

    /// Checks the values and writes the uniforms.
    pub(crate) fn fill(&self, globals: &mut Globals) -> Result<(), RenderError> {
        let Liquid { absorption, scattering, film, colour, refractive_index, roughness } = *self;
        let is_valid =
            absorption.iter().chain(&[scattering]).chain(&colour).all(|&x| x.is_finite() && x >= 0.0)
                && (0.0..=1.0).contains(&film)
                && (1.0..=3.0).contains(&refractive_index)
                && (0.02..=1.0).contains(&roughness);
        if !is_valid {
            return Err(RenderError::Value {
                what: "the liquid",
                given: format!("{:?}", self),
                allowed: "finite non-negative numbers, a film of 0 to 1, a refractive index of 1 to 3, a roughness of \
                          0.02 to 1",
            });
        }
        globals.liquid_absorption = absorption;
        globals.liquid_scattering = scattering;
        globals.liquid_film = film;
        globals.liquid_colour = colour;
        globals.refractive_index = refractive_index;
        globals.liquid_roughness = roughness;
        // Absorption tints the shadow; scattering darkens all colours.
        globals.shadow_absorption = absorption.map(|a| 0.45 * a + 0.9 * scattering);
        Ok(())
    }

    fn tinted(
        size: f32,
        absorption: [f32; 3],
        scattering: f32,
        colour: [f32; 3],
        refractive_index: f32,
    ) -> Liquid {
        // Avoids a division by zero.
        let size = size.max(1e-6);
        Liquid {
            absorption: absorption.map(|per_size| per_size / size),
            scattering: scattering / size,
            film: 0.20,
            colour,
            refractive_index,
            roughness: 0.16,
        }
    }
}
