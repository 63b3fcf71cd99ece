//! How a liquid looks.

use crate::RenderError;
use crate::globals::Globals;

/// Optical properties of a liquid in a picture.
///
/// Real water is nearly colourless over a metre: it absorbs 0.3 of the red and next to nothing of the blue
/// light (Pope and Fry 1997). Pictures of tanks have always been tinted more than that, and so the constructors
/// take the `size` over which the colour should show: the height or half the width of the box is a good choice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Liquid {
    /// Share of the light lost per metre, for red, green and blue (Beer and Lambert: `exp(-absorption * path)`).
    pub absorption: [f32; 3],
    /// Per metre, how quickly what lies behind gives way to the liquid's own colour.
    pub scattering: f32,
    /// Share of the liquid's own colour even in the thinnest places. 0 is what Beer and Lambert say; a little
    /// more keeps drops and the tank's edges visible, where light really runs a longer way by reflection
    /// inside.
    pub film: f32,
    /// The liquid's own colour where it is deep, linear RGB.
    pub colour: [f32; 3],
    /// 1.333 for water; sets how much is mirrored and how much bent.
    pub refractive_index: f32,
    /// Roughness of the mirror for the sun's glint, between 0.02 (sharp) and 1 (none).
    pub roughness: f32,
}

impl Liquid {
    /// Water, turquoise in thin places and blue in deep ones.
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

    /// The liquid of that name: `water`, `oil`, `glycerin` or `honey`.
    pub fn from_name(name: &str, size: f32) -> Option<Liquid> {
        match name {
            "water" => Some(Liquid::water(size)),
            "oil" => Some(Liquid::oil(size)),
            "glycerin" => Some(Liquid::glycerin(size)),
            "honey" => Some(Liquid::honey(size)),
            _ => None,
        }
    }

    /// Refuses looks that would draw nonsense, and hands the others to the shaders.
    pub(crate) fn fill(&self, globals: &mut Globals) -> Result<(), RenderError> {
        let Liquid { absorption, scattering, film, colour, refractive_index, roughness } = *self;
        let sound = absorption.iter().chain(&[scattering]).chain(&colour).all(|&x| x.is_finite() && x >= 0.0)
            && (0.0..=1.0).contains(&film)
            && (1.0..=3.0).contains(&refractive_index)
            && (0.02..=1.0).contains(&roughness);
        if !sound {
            return Err(RenderError::Value {
                what: "the liquid's look",
                given: format!("{:?}", self),
                allowed: "finite positive numbers, a film of 0 to 1, a refractive index of 1 to 3, a roughness of 0.02 to 1",
            });
        }
        globals.liquid_absorption = absorption;
        globals.liquid_scattering = scattering;
        globals.liquid_film = film;
        globals.liquid_colour = colour;
        globals.refractive_index = refractive_index;
        globals.liquid_roughness = roughness;
        // The shadow of a clear liquid is bright and tinted; scattering takes light of all colours away.
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
        // A size of zero would make the colour infinitely strong.
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
