//! Every key of the scene file, declared once: the reader, the JSON schema, the reference and the messages come
//! from here.
//!
//! A file for each part of a scene; the words that keys take, where they are this module's own, are in `words`.

mod fluid;
mod mesh;
mod numerics;
mod show;
mod things;
mod words;

pub use words::Side;
pub(crate) use words::{MotionWord, OutletWord, QuantityWord, ShapeWord, SinkWord};

use fluid::FLUID;
use numerics::{FOAM, SOLVER, SURFACE};
use show::{CAMERA, OUTPUT};
use things::{BODY, EMITTER, PROBE, SINK};

use super::spec::{Kind, Table, a_number, a_vector, key, words};

/// Coordinates beyond this many metres are surely a mistake.
const FAR: f64 = 10_000.0;
/// Most bodies in a scene.
const MAX_BODIES: usize = 1024;
/// Most emitters in a scene.
const MAX_EMITTERS: usize = 64;
/// Most sinks in a scene.
const MAX_SINKS: usize = 64;
/// Most probes in a scene.
const MAX_PROBES: usize = 256;

pub(crate) static ROOT: Table = Table {
    about: "A scene for Splashdown: SI units, y is up.",
    keys: &[
        key("scene", Kind::Table(&SCENE), "What the scene is called and how long it runs.").required(),
        key("domain", Kind::Table(&DOMAIN), "The box that holds the fluid.").required(),
        key("fluid", Kind::Table(&FLUID), "The fluid and where it starts.").required(),
        key("body", Kind::Tables(&BODY, MAX_BODIES), "Solids that the fluid meets.")
            .also(&["bodies", "mesh", "object"]),
        key("emitter", Kind::Tables(&EMITTER, MAX_EMITTERS), "Sources of fluid.")
            .also(&["emitters", "inlet", "source"]),
        key("sink", Kind::Tables(&SINK, MAX_SINKS), "Where fluid leaves for good.")
            .also(&["sinks", "drain", "outlet"]),
        key("probe", Kind::Tables(&PROBE, MAX_PROBES), "What is measured while it runs.")
            .also(&["probes", "gauge", "gauges", "sensor", "measure"]),
        key("solver", Kind::Table(&SOLVER), "How the fluid is computed."),
        key("surface", Kind::Table(&SURFACE), "How the fluid's surface is extracted."),
        key("foam", Kind::Table(&FOAM), "Whether a splash makes foam, spray and bubbles.").also(&[
            "spray",
            "bubbles",
            "diffuse",
            "whitewater",
        ]),
        key(
            "camera",
            Kind::Table(&CAMERA),
            "From where the fluid is seen; without it the whole domain is in view.",
        ),
        key("output", Kind::Table(&OUTPUT), "What is written."),
    ],
};

static SCENE: Table = Table {
    about: "What the scene is called and how long it runs.",
    keys: &[
        key("name", Kind::Name, "Short name; also the name of the output folder.")
            .required()
            .also(&["title"]),
        key("duration", a_number(1e-4, 3600.0, "s"), "Simulated time.")
            .required()
            .also(&["time", "end_time", "t_end"]),
        key("frame_rate", a_number(0.1, 10_000.0, "1/s"), "Frames per simulated second.")
            .default("50.0")
            .also(&["fps", "rate"]),
        key("gravity", a_vector(1000.0, "m/s^2"), "Gravity.").default("[0.0, -9.81, 0.0]").also(&["g"]),
    ],
};

static DOMAIN: Table = Table {
    about: "The box that holds the fluid.",
    keys: &[
        key("min", a_vector(FAR, "m"), "Lower corner.").required().also(&["lower", "origin"]),
        key("max", a_vector(FAR, "m"), "Upper corner.").required().also(&["upper"]),
        key("open", Kind::Words(words::<Side>), "Sides without a wall.").default("[]"),
        key("shake", Kind::Table(&SHAKE), "Moves the whole tank by amplitude * sin(2 pi t / period)."),
    ],
};

static SHAKE: Table = Table {
    about: "A harmonic motion of the tank.",
    keys: &[
        key("amplitude", a_vector(100.0, "m"), "Amplitude along each axis.").required(),
        key("period", a_number(1e-3, 3600.0, "s"), "Period.").required(),
    ],
};
