//! How pictures and the window draw a scene: sky, floor, tank, liquid and caption.

use super::choice::choices;

choices! {
    /// The sky of the pictures.
    SkyKind {
        /// Blue with scattered clouds.
        Day = "day",
        /// Grey clouds, no sun.
        Overcast = "overcast",
        /// A low sun and an orange horizon.
        Sunset = "sunset",
        /// An even white background.
        Studio = "studio",
    }
    /// The floor of the pictures.
    FloorKind {
        /// Slate with joints at a round distance.
        Tiles = "tiles",
        /// Light and dark squares.
        Checkerboard = "checkerboard",
        /// One colour.
        Plain = "plain",
        /// No floor.
        None = "none",
    }
    /// How the domain is drawn.
    TankKind {
        /// Panes of glass around a liquid, lines around particles.
        Glass = "glass",
        /// Lines.
        Edges = "edges",
        /// Not drawn.
        None = "none",
    }
    /// Optical properties of a liquid.
    LiquidKind {
        /// Pure water.
        Water = "water",
        /// Vegetable oil.
        Oil = "oil",
        /// Glycerin.
        Glycerin = "glycerin",
        /// Honey.
        Honey = "honey",
        /// Green-blue, slightly turbid water.
        Sea = "sea",
        /// Brown, turbid water.
        Murky = "murky",
        /// Whole milk.
        Milk = "milk",
    }
}

/// How pictures and the window draw a scene. Nothing here affects the simulation. `None` is the value of the sky,
/// of the floor or of the liquid.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PictureSettings {
    /// The sky.
    pub sky: SkyKind,
    /// Light from straight above: linear red, green and blue.
    pub zenith_colour: Option<[f32; 3]>,
    /// Light from the horizon: linear red, green and blue.
    pub horizon_colour: Option<[f32; 3]>,
    /// Whether there is a sun.
    pub sun: Option<bool>,
    /// Angle of the sun above the horizon in degrees.
    pub sun_elevation: Option<f32>,
    /// Angle of the sun about the y axis in degrees: 0 is +z, 90 is +x.
    pub sun_azimuth: Option<f32>,
    /// The floor.
    pub floor: FloorKind,
    /// Mean reflectance of the floor: linear red, green and blue.
    pub floor_colour: Option<[f32; 3]>,
    /// How the domain is drawn.
    pub tank: TankKind,
    /// Optical properties of the liquid; `None`: those of the material.
    pub liquid: Option<LiquidKind>,
    /// Absorption of the liquid for red, green and blue, in 1/m.
    pub absorption: Option<[f32; 3]>,
    /// Scattering of the liquid in 1/m.
    pub scattering: Option<f32>,
    /// Colour of the light that the liquid scatters: linear red, green and blue.
    pub liquid_colour: Option<[f32; 3]>,
    /// Text in the lower left corner, in which `{name}` and `{time}` are replaced; `None`: name and time in
    /// pictures, nothing in the window. Empty: no text.
    pub caption: Option<String>,
}

impl PictureSettings {
    /// Whether the sun shines: [`sun`](Self::sun), or as the sky.
    pub fn has_sun(&self) -> bool {
        self.sun.unwrap_or(self.sky != SkyKind::Overcast)
    }
}

impl LiquidKind {
    /// Whether it scatters light.
    pub(crate) fn is_turbid(self) -> bool {
        matches!(self, Self::Sea | Self::Murky | Self::Milk)
    }
}

impl Default for PictureSettings {
    fn default() -> Self {
        Self {
            sky: SkyKind::Day,
            zenith_colour: None,
            horizon_colour: None,
            sun: None,
            sun_elevation: None,
            sun_azimuth: None,
            floor: FloorKind::Tiles,
            floor_colour: None,
            tank: TankKind::Glass,
            liquid: None,
            absorption: None,
            scattering: None,
            liquid_colour: None,
            caption: None,
        }
    }
}
