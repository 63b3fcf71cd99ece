//! Keys of `[picture]`.

use crate::scene::picture::{FloorKind, LiquidKind, SkyKind, TankKind};
use crate::scene::spec::{Kind, Table, a_number, key, range, words};

/// Light as linear red, green and blue; in a light of 1, white is drawn as white.
const LIGHT: Kind = Kind::Numbers(3, range(0.0, 10.0, ""));
/// A reflectance as linear red, green and blue.
const COLOUR: Kind = Kind::Numbers(3, range(0.0, 1.0, ""));

pub(super) static PICTURE: Table = Table {
    about: "Appearance of the pictures and of the window; it does not affect the simulation.",
    keys: &[
        key("sky", Kind::Word(words::<SkyKind>), "The sky and its light.")
            .default("\"day\"")
            .also(&["background", "environment", "lighting"]),
        key(
            "zenith_colour",
            LIGHT,
            "Light from straight above: linear red, green, blue. Default: that of the sky.",
        )
        .also(&["sky_colour", "zenith", "zenith_color"]),
        key(
            "horizon_colour",
            LIGHT,
            "Light from the horizon: linear red, green, blue. Default: that of the sky.",
        )
        .also(&["horizon", "horizon_color"]),
        key("sun", Kind::Boolean, "Whether the sun shines. Default: yes, except under an overcast sky."),
        key(
            "sun_elevation",
            a_number(6.0, 90.0, "degrees"),
            "Angle of the sun above the horizon. Default: that of the sky.",
        ),
        key(
            "sun_azimuth",
            a_number(-360.0, 360.0, "degrees"),
            "Angle of the sun about y: 0 is +z, 90 is +x. Default: that of the sky.",
        ),
        key("floor", Kind::Word(words::<FloorKind>), "The floor below the domain.")
            .default("\"tiles\"")
            .also(&["ground"]),
        key(
            "floor_colour",
            COLOUR,
            "Mean reflectance of the floor: linear red, green, blue. Default: grey slate.",
        )
        .also(&["floor_color", "ground_colour"]),
        key("tank", Kind::Word(words::<TankKind>), "How the domain is drawn.")
            .default("\"glass\"")
            .also(&["box", "panes", "walls"]),
        key(
            "liquid",
            Kind::Word(words::<LiquidKind>),
            "Optical properties of the liquid. Default: those of the material.",
        )
        .also(&["water", "fluid", "material"]),
        key(
            "absorption",
            Kind::Numbers(3, range(0.0, 10_000.0, "1/m")),
            "Absorption of red, green and blue light. Default: that of the liquid.",
        )
        .also(&["absorption_coefficient", "attenuation"]),
        key(
            "scattering",
            a_number(0.0, 10_000.0, "1/m"),
            "Turbidity: the inverse of the distance over which the liquid hides what is behind it. Default: that of \
             the liquid.",
        )
        .also(&["turbidity"]),
        key(
            "liquid_colour",
            COLOUR,
            "Colour of the light that a turbid liquid scatters: linear red, green, blue. Default: that of the liquid.",
        )
        .also(&["liquid_color", "water_colour", "colour", "color"]),
        key(
            "caption",
            Kind::Line("a text, in which {name} and {time} are replaced, or \"\" for no caption"),
            "Text in the lower left corner. Default: name and time in pictures, none in the window.",
        )
        .also(&["text", "label", "title"]),
    ],
};
