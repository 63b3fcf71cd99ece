//! Every key of the scene file. The reader, the JSON schema, the reference and the messages are generated from these
//! tables.
//!
//! Each part of a scene has its own file; `words` has the values of keys that only this module uses.

mod fluid;
mod mesh;
mod numerics;
mod picture;
mod show;
mod things;
mod words;

pub use words::Side;
pub(crate) use words::{MotionWord, OutletWord, QuantityWord, ShapeWord, SinkWord};

use fluid::FLUID;
use numerics::{FOAM, SOLVER, SURFACE};
use picture::PICTURE;
pub(super) use show::CAMERA_PATH;
use show::{CAMERA, OUTPUT};
use things::{BODY, EMITTER, PROBE, SINK};

use super::spec::{Kind, Table, a_number, a_vector, key, words};

/// Largest coordinate in m.
const FAR: f64 = 10_000.0;
/// Maximum number of bodies in a scene.
const MAX_BODIES: usize = 1024;
/// Maximum number of emitters in a scene.
const MAX_EMITTERS: usize = 64;
/// Maximum number of sinks in a scene.
const MAX_SINKS: usize = 64;
/// Maximum number of probes in a scene.
const MAX_PROBES: usize = 256;

pub(crate) static ROOT: Table = Table {
    about: "A scene for Splashdown: SI units, y is up.",
    keys: &[
        key("scene", Kind::Table(&SCENE), "Name, duration and gravity of the scene.").required(),
        key("domain", Kind::Table(&DOMAIN), "The box that contains the fluid.").required(),
        key("fluid", Kind::Table(&FLUID), "The fluid and its initial shape.").required(),
        key("body", Kind::Tables(&BODY, MAX_BODIES), "Solid bodies.").also(&["bodies", "mesh", "object"]),
        key("emitter", Kind::Tables(&EMITTER, MAX_EMITTERS), "Sources of fluid.")
            .also(&["emitters", "inlet", "source"]),
        key("sink", Kind::Tables(&SINK, MAX_SINKS), "Regions that remove fluid.")
            .also(&["sinks", "drain", "outlet"]),
        key("probe", Kind::Tables(&PROBE, MAX_PROBES), "Measurements during the run.")
            .also(&["probes", "gauge", "gauges", "sensor", "measure"]),
        key("solver", Kind::Table(&SOLVER), "Solver and its parameters."),
        key("surface", Kind::Table(&SURFACE), "Surface reconstruction."),
        key("foam", Kind::Table(&FOAM), "Foam, spray and bubbles.").also(&[
            "spray",
            "bubbles",
            "diffuse",
            "whitewater",
        ]),
        key("camera", Kind::Table(&CAMERA), "View of the pictures; without it the whole domain is visible."),
        key(
            "picture",
            Kind::Table(&PICTURE),
            "Sky, floor, tank, colour of the liquid and caption in pictures.",
        )
        .also(&["appearance", "look", "render", "rendering"]),
        key("output", Kind::Table(&OUTPUT), "Output files."),
    ],
};

static SCENE: Table = Table {
    about: "Name, duration and gravity of the scene.",
    keys: &[
        key("name", Kind::Name, "Name of the scene and of its output folder.").required().also(&["title"]),
        key("duration", a_number(1e-4, 3600.0, "s"), "Simulated time.")
            .required()
            .also(&["time", "end_time", "t_end"]),
        key("frame_rate", a_number(0.1, 10_000.0, "1/s"), "Frames per simulated second.")
            .default("50.0")
            .also(&["fps", "rate"]),
        key("gravity", a_vector(1000.0, "m/s^2"), "Gravitational acceleration.")
            .default("[0.0, -9.81, 0.0]")
            .also(&["g"]),
    ],
};

static DOMAIN: Table = Table {
    about: "The box that contains the fluid.",
    keys: &[
        key("min", a_vector(FAR, "m"), "Lower corner.").required().also(&["lower", "origin"]),
        key("max", a_vector(FAR, "m"), "Upper corner.").required().also(&["upper"]),
        key(
            "open",
            Kind::Words(words::<Side>),
            "Sides without a wall; particles that leave there are removed.",
        )
        .default("[]"),
        key(
            "oscillation",
            Kind::Table(&OSCILLATION),
            "Moves the domain by amplitude * sin(2 pi t / period).",
        )
        .also(&["sway", "motion"])
        .formerly(&["shake"]),
    ],
};

static OSCILLATION: Table = Table {
    about: "Harmonic motion of the domain: amplitude * sin(2 pi t / period).",
    keys: &[
        key("amplitude", a_vector(100.0, "m"), "Amplitude along each axis.").required(),
        key("period", a_number(1e-3, 3600.0, "s"), "Period.").required(),
    ],
};
