//! Keys of `[camera]` and `[output]`: what is shown and kept.

use super::FAR;
use crate::scene::spec::{Kind, Table, a_number, a_vector, key, range, words};
use crate::scene::types::{ColourBy, Format, PictureKind};

pub(super) static CAMERA: Table = Table {
    about: "From where the fluid is seen.",
    keys: &[
        key("target", a_vector(FAR, "m"), "The point in the middle. Default: the middle of the domain.")
            .also(&["look_at", "center"]),
        key(
            "distance",
            a_number(1e-4, FAR, "m"),
            "Distance of the eye from the target. Default: the whole domain is in view.",
        ),
        key("azimuth", a_number(-360.0, 360.0, "degrees"), "Angle around y: 0 looks from +z, 90 from +x.")
            .default("25.0")
            .also(&["yaw", "angle"]),
        key("elevation", a_number(-89.0, 89.0, "degrees"), "Angle above the horizon.")
            .default("20.0")
            .also(&["pitch"]),
        key("field_of_view", a_number(5.0, 120.0, "degrees"), "Vertical angle of view.")
            .default("35.0")
            .also(&["fov"]),
        key("orbit_speed", a_number(-3600.0, 3600.0, "degrees/s"), "How fast the azimuth grows.")
            .default("0.0"),
    ],
};

pub(super) static OUTPUT: Table = Table {
    about: "What is written.",
    keys: &[
        key("formats", Kind::Words(words::<Format>), "File formats of the frames.")
            .default("[\"ply\"]")
            .also(&["format"]),
        key("pictures", Kind::Words(words::<PictureKind>), "Pictures of each frame.")
            .default("[\"particles\", \"surface\"]")
            .also(&["picture", "images"]),
        key(
            "picture_size",
            Kind::Integers(2, range(16.0, 8192.0, "pixels")),
            "Width and height of a picture; even numbers for a film.",
        )
        .default("[1280, 720]")
        .also(&["resolution", "size"]),
        key("colour_by", Kind::Word(words::<ColourBy>), "What colours the particles.").default("\"speed\""),
        key("film", Kind::Boolean, "Whether the pictures become a film.")
            .default("true")
            .also(&["video", "movie"]),
        key(
            "colour_range",
            Kind::Numbers(2, range(-1e12, 1e12, "")),
            "The quantity at both ends of the colour bar. Default: chosen from the scene.",
        ),
    ],
};
