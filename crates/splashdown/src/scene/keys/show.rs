//! Keys of `[camera]` and `[output]`.

use super::FAR;
use crate::scene::spec::{Kind, Table, a_number, a_vector, key, range, words};
use crate::scene::types::{ColourBy, Format, PictureKind, PictureQuality};

/// Maximum number of keyframes of a camera.
const MAX_KEYFRAMES: usize = 1000;

pub(super) static CAMERA: Table = Table {
    about: "View of the pictures.",
    keys: &[
        key(
            "target",
            a_vector(FAR, "m"),
            "Point at the centre of the picture. Default: the centre of the domain.",
        )
        .also(&["look_at", "center"]),
        key(
            "distance",
            a_number(1e-4, FAR, "m"),
            "Distance of the camera from the target. Default: the whole domain is visible.",
        ),
        key("azimuth", a_number(-360.0, 360.0, "degrees"), "Angle about y: 0 looks from +z, 90 from +x.")
            .default("25.0")
            .also(&["yaw", "angle"]),
        key("elevation", a_number(-89.0, 89.0, "degrees"), "Angle above the horizon.")
            .default("20.0")
            .also(&["pitch"]),
        key("field_of_view", a_number(5.0, 120.0, "degrees"), "Vertical angle of view.")
            .default("35.0")
            .also(&["fov"]),
        key("orbit_speed", a_number(-3600.0, 3600.0, "degrees/s"), "Rate of change of the azimuth.")
            .default("0.0"),
        key("keyframe", Kind::Tables(&KEYFRAME, MAX_KEYFRAMES), "Places of the camera at given times.")
            .also(&["keyframes", "path"]),
    ],
};

/// A file with a camera path.
pub(in crate::scene) static CAMERA_PATH: Table = Table {
    about: "The path of a camera.",
    keys: &[key("keyframe", Kind::Tables(&KEYFRAME, MAX_KEYFRAMES), "Places of the camera at given times.")
        .also(&["keyframes", "path"])],
};

static KEYFRAME: Table = Table {
    about: "The place of the camera at a given time. The camera moves smoothly between keyframes and rests before the first \
            and after the last. Keys that are not given are those of [camera].",
    keys: &[
        key("time", a_number(0.0, 3600.0, "s"), "Simulated time.").required().also(&["t"]),
        key("target", a_vector(FAR, "m"), "Point at the centre of the picture.").also(&["look_at", "center"]),
        key("eye", a_vector(FAR, "m"), "Place of the camera, instead of distance, azimuth and elevation.")
            .also(&["position"]),
        key("distance", a_number(1e-4, FAR, "m"), "Distance of the camera from the target."),
        key(
            "azimuth",
            a_number(-36_000.0, 36_000.0, "degrees"),
            "Angle about y; 350 to 370 turns the camera by 20 degrees.",
        )
        .also(&["yaw", "angle"]),
        key("elevation", a_number(-89.0, 89.0, "degrees"), "Angle above the horizon.").also(&["pitch"]),
        key("field_of_view", a_number(5.0, 120.0, "degrees"), "Vertical angle of view.").also(&["fov"]),
    ],
};

pub(super) static OUTPUT: Table = Table {
    about: "Output files.",
    keys: &[
        key("formats", Kind::Words(words::<Format>), "File formats of the frames.")
            .default("[\"ply\"]")
            .also(&["format"]),
        key("pictures", Kind::Words(words::<PictureKind>), "Pictures drawn of each frame.")
            .default("[\"particles\", \"surface\"]")
            .also(&["picture", "images"]),
        key(
            "picture_size",
            Kind::Integers(2, range(16.0, 32_768.0, "pixels")),
            "Width and height of the pictures, at most 268 million pixels in all; a film needs even numbers up to 8192.",
        )
        .default("[1280, 720]")
        .also(&["resolution", "size"]),
        key(
            "quality",
            Kind::Word(words::<PictureQuality>),
            "How carefully pictures of the surface are drawn.",
        )
        .default("\"interactive\""),
        key("colour_by", Kind::Word(words::<ColourBy>), "Quantity that colours the particles.")
            .default("\"speed\""),
        key("film", Kind::Boolean, "Whether a film is made of the pictures.")
            .default("true")
            .also(&["video", "movie"]),
        key(
            "colour_range",
            Kind::Numbers(2, range(-1e12, 1e12, "")),
            "Values at the ends of the colour bar. Default: derived from the scene.",
        ),
    ],
};
