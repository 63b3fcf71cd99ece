//! Display settings.

use splashdown::scene::ColourBy;
use splashdown_render::{Axis, ColourMap};

/// How the fluid is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DisplayMode {
    /// Particles as spheres, coloured by a quantity.
    Particles,
    /// A liquid reconstructed from the particles in screen space.
    Liquid,
    /// The surface by marching cubes, as water.
    Surface,
    /// The triangles of that surface.
    Mesh,
    /// A plane through the fluid, coloured by a quantity.
    Slice,
}

impl DisplayMode {
    /// All modes, in the order of their keys.
    pub const ALL: [Self; 5] = [Self::Particles, Self::Liquid, Self::Surface, Self::Mesh, Self::Slice];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Particles => "Particles",
            Self::Liquid => "Liquid",
            Self::Surface => "Surface",
            Self::Mesh => "Mesh",
            Self::Slice => "Slice",
        }
    }

    /// Its explanation.
    pub fn hint(self) -> &'static str {
        match self {
            Self::Particles => "Particles as spheres, coloured by a quantity",
            Self::Liquid => "A liquid reconstructed from the particles in screen space: fast, without a mesh",
            Self::Surface => "The surface by marching cubes, which is the mesh that is exported",
            Self::Mesh => "The triangles of the surface",
            Self::Slice => "A plane through the fluid, coloured by density, speed or pressure",
        }
    }

    /// Whether it needs the surface.
    pub fn needs_surface(self) -> bool {
        matches!(self, Self::Surface | Self::Mesh)
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
            mode: DisplayMode::Liquid,
            colour_by: ColourBy::Speed,
            map: ColourMap::Water,
            slice_axis: Axis::Z,
            slice_at: 0.5,
        }
    }
}
