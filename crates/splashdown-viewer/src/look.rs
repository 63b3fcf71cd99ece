//! How the fluid is shown.

use splashdown::scene::ColourBy;
use splashdown_render::{Axis, ColourMap};

/// A way to see the fluid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Balls, coloured by a quantity.
    Particles,
    /// A liquid drawn from the particles in screen space.
    Fluid,
    /// The surface by marching cubes, as water.
    Surface,
    /// The triangles of that surface.
    Mesh,
    /// A plane through the fluid, coloured by a quantity.
    Slice,
}

impl Way {
    /// All ways, in the order of their keys.
    pub const ALL: [Self; 5] = [Self::Particles, Self::Fluid, Self::Surface, Self::Mesh, Self::Slice];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Particles => "Particles",
            Self::Fluid => "Fluid",
            Self::Surface => "Surface",
            Self::Mesh => "Mesh",
            Self::Slice => "Slice",
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
            Self::Mesh => "The triangles of the surface: how it is made",
            Self::Slice => {
                "A plane through the fluid, coloured by density, speed or pressure: what is inside"
            }
        }
    }

    /// True if the surface has to be extracted for it.
    pub fn needs_surface(self) -> bool {
        matches!(self, Self::Surface | Self::Mesh)
    }

    /// True if colours stand for a quantity.
    pub fn has_colours(self) -> bool {
        matches!(self, Self::Particles | Self::Slice)
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
    /// Across which axis a slice lies.
    pub slice_axis: Axis,
    /// Where it lies along that axis, as a part of the box.
    pub slice_at: f32,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            way: Way::Fluid,
            colour_by: ColourBy::Speed,
            map: ColourMap::Water,
            slice_axis: Axis::Z,
            slice_at: 0.5,
        }
    }
}
