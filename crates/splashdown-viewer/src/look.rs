//! How the fluid is shown.

use splashdown::scene::ColourBy;
use splashdown_render::ColourMap;

/// A way to see the fluid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Balls, coloured by a quantity.
    Particles,
    /// A liquid drawn from the particles in screen space.
    Fluid,
    /// The surface by marching cubes, as water.
    Surface,
}

impl Way {
    /// All ways, in the order of their keys.
    pub const ALL: [Self; 3] = [Self::Particles, Self::Fluid, Self::Surface];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Particles => "Particles",
            Self::Fluid => "Fluid",
            Self::Surface => "Surface",
        }
    }

    /// What it is for.
    pub fn hint(self) -> &'static str {
        match self {
            Self::Particles => {
                "Each particle as a ball, coloured by a quantity: to see what the simulation does"
            }
            Self::Fluid => {
                "A liquid drawn from the particles as they are seen: smooth and quick, without a mesh"
            }
            Self::Surface => "The fluid's surface by marching cubes, the same mesh that is exported",
        }
    }

    /// True if the surface has to be extracted for it.
    pub fn needs_surface(self) -> bool {
        self == Self::Surface
    }
}

/// Everything that changes the picture and not the water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// The way.
    pub way: Way,
    /// What colours particles.
    pub colour_by: ColourBy,
    /// With which colours.
    pub map: ColourMap,
}

impl Default for Look {
    fn default() -> Self {
        Self { way: Way::Fluid, colour_by: ColourBy::Speed, map: ColourMap::Water }
    }
}
