//! Display settings.

use splashdown::scene::ColourBy;
use splashdown_render::{Axis, ColourMap};

/// How the fluid is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DisplayMode {
    /// Particles as spheres, coloured by a quantity.
    Particles,
    /// The particles drawn as one smooth surface in screen space.
    Smooth,
    /// The surface by marching cubes.
    Surface,
    /// The triangles of that surface.
    Triangles,
    /// A plane through the fluid, coloured by a quantity.
    Slice,
}

impl DisplayMode {
    /// All modes, in the order of their keys.
    pub const ALL: [Self; 5] = [Self::Particles, Self::Smooth, Self::Surface, Self::Triangles, Self::Slice];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Particles => "Particles",
            Self::Smooth => "Smooth",
            Self::Surface => "Surface",
            Self::Triangles => "Triangles",
            Self::Slice => "Slice",
        }
    }

    /// Its explanation.
    pub fn hint(self) -> &'static str {
        match self {
            Self::Particles => "Particles as spheres, coloured by a quantity",
            Self::Smooth => "The particles drawn as one smooth surface in screen space: fast",
            Self::Surface => "The surface by marching cubes, which can be exported",
            Self::Triangles => "The triangles of the surface",
            Self::Slice => "A plane through the fluid, coloured by density, speed or pressure",
        }
    }

    /// Whether it needs the surface.
    pub fn needs_surface(self) -> bool {
        matches!(self, Self::Surface | Self::Triangles)
    }

    /// Whether it needs the particles.
    pub fn needs_particles(self) -> bool {
        !self.needs_surface()
    }

    /// Whether colours represent a quantity.
    pub fn has_colours(self) -> bool {
        matches!(self, Self::Particles | Self::Slice)
    }
}

/// The display settings, which do not affect the simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// What is drawn.
    pub mode: DisplayMode,
    /// The quantity that particles are coloured by.
    pub colour_by: ColourBy,
    /// The colour map.
    pub map: ColourMap,
    /// The normal of the slice.
    pub slice_axis: Axis,
    /// The position of the slice along that axis, as a fraction of the domain.
    pub slice_at: f32,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            mode: DisplayMode::Smooth,
            colour_by: ColourBy::Speed,
            map: ColourMap::Water,
            slice_axis: Axis::Z,
            slice_at: 0.5,
        }
    }
}
