//! Optical properties of liquids.

use crate::RenderError;
use crate::globals::Globals;

/// Optical properties of a liquid.
///
/// Water is nearly colourless over one metre: it absorbs a quarter of red and almost none of blue
/// light. What makes it visible is refraction and reflection.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Liquid {
    /// Absorption coefficient for red, green and blue, 1/m (Beer-Lambert: `exp(-absorption *
    /// path)`).
    pub absorption: [f32; 3],
    /// Rate at which the liquid's own colour replaces the background, 1/m.
    pub scattering: f32,
    /// The liquid's own colour at large depth, linear RGB.
    pub colour: [f32; 3],
    /// Refractive index, 1.333 for water.
    pub refractive_index: f32,
    /// Roughness of the surface for the highlight of the sun, from 0.02 (sharp) to 1 (diffuse).
    pub roughness: f32,
}

impl Liquid {
    /// Pure water: absorption as measured by Pope and Fry (1997) at 610, 550 and 465 nm.
    pub fn water() -> Liquid {
        Liquid::clear([0.264, 0.0565, 0.0101], 1.333)
    }

    /// Vegetable oil, pale gold. The absorption is an estimate from its colour in a glass.
    pub fn oil() -> Liquid {
        Liquid::clear([0.6, 2.2, 18.0], 1.47)
    }

    /// Glycerin, colourless.
    pub fn glycerin() -> Liquid {
        Liquid::clear([0.30, 0.12, 0.10], 1.473)
    }

    /// Honey, amber. The absorption is an estimate from its colour in a jar.
    pub fn honey() -> Liquid {
        Liquid::clear([2.5, 14.0, 80.0], 1.49)
    }

    /// Turbid green-blue water near a coast. The values are estimates.
    pub fn sea() -> Liquid {
        Liquid { scattering: 0.35, colour: [0.012, 0.11, 0.13], ..Liquid::clear([0.55, 0.10, 0.09], 1.339) }
    }

    /// Brown water with silt, as in a river after rain. The values are estimates.
    pub fn murky() -> Liquid {
        Liquid { scattering: 4.0, colour: [0.13, 0.095, 0.045], ..Liquid::clear([1.2, 1.6, 3.2], 1.333) }
    }

    /// Whole milk: absorption, reduced scattering of green light, and diffuse reflectance as measured
    /// by Jensen et al. (2001), "A practical model for subsurface light transport".
    pub fn milk() -> Liquid {
        Liquid { scattering: 3210.0, colour: [0.91, 0.88, 0.76], ..Liquid::clear([1.1, 2.4, 14.0], 1.35) }
    }

    /// The liquid with a name: `water`, `oil`, `glycerin`, `honey`, `sea`, `murky` or `milk`.
    pub fn from_name(name: &str) -> Option<Liquid> {
        match name {
            "water" => Some(Liquid::water()),
            "oil" => Some(Liquid::oil()),
            "glycerin" => Some(Liquid::glycerin()),
            "honey" => Some(Liquid::honey()),
            "sea" => Some(Liquid::sea()),
            "murky" => Some(Liquid::murky()),
            "milk" => Some(Liquid::milk()),
            _ => None,
        }
    }

    /// Checks the values and writes the uniforms.
    pub(crate) fn fill(&self, globals: &mut Globals) -> Result<(), RenderError> {
        let Liquid { absorption, scattering, colour, refractive_index, roughness } = *self;
        let is_valid =
            absorption.iter().chain(&[scattering]).chain(&colour).all(|&x| x.is_finite() && x >= 0.0)
                && (1.0..=3.0).contains(&refractive_index)
                && (0.02..=1.0).contains(&roughness);
        if !is_valid {
            return Err(RenderError::Value {
                what: "the liquid",
                given: format!("{:?}", self),
                allowed: "finite non-negative numbers, a refractive index of 1 to 3, a roughness of \
                          0.02 to 1",
            });
        }
        globals.liquid_absorption = absorption;
        globals.liquid_scattering = scattering;
        globals.liquid_colour = colour;
        globals.refractive_index = refractive_index;
        globals.liquid_roughness = roughness;
        // Absorption tints the shadow; scattering darkens all colours.
        globals.shadow_absorption = absorption.map(|a| a + scattering);
        Ok(())
    }

    fn clear(absorption: [f32; 3], refractive_index: f32) -> Liquid {
        Liquid { absorption, scattering: 0.0, colour: [0.0; 3], refractive_index, roughness: 0.16 }
    }
}
