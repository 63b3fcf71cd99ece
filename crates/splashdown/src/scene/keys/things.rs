//! Keys of bodies, emitters, sinks and probes.

use super::FAR;
use super::mesh::{MESH, POSITION, ROTATION, SCALE, UP};
use super::words::{MotionWord, OutletWord, QuantityWord, SinkWord};
use crate::scene::formula;
use crate::scene::spec::{Kind, Table, a_number, a_vector, key, range, words};
use crate::scene::things::BoundaryKind;

/// Most keyframes of a body.
const MAX_KEYFRAMES: usize = 4096;

pub(super) static BODY: Table = Table {
    about: "A solid that the fluid meets: it stands, moves as written, or is carried.",
    keys: &[
        key("name", Kind::Name, "Its name in messages and files.").required(),
        MESH.required().also(&["file", "model", "geometry_file", "shape"]),
        SCALE,
        UP,
        POSITION,
        ROTATION,
        key(
            "motion",
            Kind::Word(words::<MotionWord>),
            "How it moves. Default: static; scripted where a keyframe, move or turn is given.",
        )
        .also(&["type", "dynamic"]),
        key(
            "density",
            a_number(50.0, 30_000.0, "kg/m^3"),
            "Of a dynamic body. A body lighter than a twentieth of water is thrown by it: the coupling is explicit.",
        )
            .default("500.0")
            .also(&["rho"]),
        key("velocity", a_vector(1000.0, "m/s"), "Of a dynamic body at the start.")
            .default("[0.0, 0.0, 0.0]"),
        key("angular_velocity", a_vector(1000.0, "rad/s"), "Of a dynamic body at the start.")
            .default("[0.0, 0.0, 0.0]"),
        key(
            "hinge",
            a_vector(FAR, ""),
            "The axis, of any length, about which a dynamic body turns and which holds it: a wheel, a door.",
        )
        .also(&["axis", "axle"]),
        key("hinge_point", a_vector(FAR, "m"), "A point of that axis. Default: the body's position."),
        key(
            "move",
            Kind::Texts(3, formula::ALLOWED),
            "Formulas of t added to the position, in m: [\"0.1*sin(2*pi*t)\", \"0\", \"0\"].",
        ),
        key(
            "turn",
            Kind::Texts(3, formula::ALLOWED),
            "Formulas of t by which the mesh turns about its own x, then y, then z, in degrees.",
        ),
        key("keyframe", Kind::Tables(&KEYFRAME, MAX_KEYFRAMES), "Where it is at which time.")
            .also(&["keyframes"]),
        key("friction", a_number(0.0, 1.0, ""), "0: the fluid slips along it; 1: it sticks.").default("0.0"),
        key("adhesion", a_number(0.0, 100.0, "m/s^2"), "How strongly it pulls the fluid beside it.")
            .default("0.0"),
        key("boundary", Kind::Word(words::<BoundaryKind>), "How the fluid feels it.").default("\"map\""),
        key(
            "shell",
            Kind::Boolean,
            "Whether the mesh is a sheet with a thickness. Default: decided by the mesh.",
        ),
        key(
            "half_thickness",
            a_number(1e-6, 10.0, "m"),
            "Half the thickness of a sheet. Default: half the particle spacing.",
        )
        .also(&["thickness"]),
        key("colour", Kind::Numbers(3, range(0.0, 1.0, "")), "Linear red, green, blue in pictures.")
            .also(&["color"]),
    ],
};

pub(super) static EMITTER: Table = Table {
    about: "A source of fluid: a nozzle from which particles leave in layers.",
    keys: &[
        key("name", Kind::Name, "Its name in messages.").required(),
        key("shape", Kind::Word(words::<OutletWord>), "The shape of its outlet.").default("\"disc\""),
        key("radius", a_number(1e-5, FAR, "m"), "Radius of a disc."),
        key("size", Kind::Numbers(2, range(1e-5, FAR, "m")), "Edge lengths of a rectangle: across, and up."),
        MESH,
        SCALE,
        UP,
        ROTATION,
        key("position", a_vector(FAR, "m"), "The middle of the outlet; a mesh's origin.")
            .required()
            .also(&["center", "translation"]),
        key("direction", a_vector(FAR, ""), "Along which the fluid leaves; of any length.")
            .required()
            .also(&["normal"]),
        key("speed", a_number(1e-3, 1000.0, "m/s"), "How fast.").required().also(&["velocity"]),
        key("start", a_number(0.0, 3600.0, "s"), "When it begins.").default("0.0").also(&["start_time"]),
        key("end", a_number(0.0, 3600.0, "s"), "When it ends. Default: with the scene.")
            .also(&["end_time", "stop"]),
        key("max_particles", Kind::Integer(range(1.0, 67_108_864.0, "")), "Most particles it makes.")
            .also(&["cap"]),
    ],
};

pub(super) static SINK: Table = Table {
    about: "A place where fluid leaves for good.",
    keys: &[
        key("name", Kind::Name, "Its name in messages.").required(),
        key("shape", Kind::Word(words::<SinkWord>), "Its shape.").default("\"box\""),
        key("min", a_vector(FAR, "m"), "Lower corner of a box."),
        key("max", a_vector(FAR, "m"), "Upper corner of a box."),
        key("point", a_vector(FAR, "m"), "A point of a plane."),
        key("normal", a_vector(FAR, ""), "Away from what is taken out; of any length."),
        MESH,
        SCALE,
        UP,
        POSITION,
        ROTATION,
    ],
};

pub(super) static PROBE: Table = Table {
    about: "Something that is measured in every step and written as probes/NAME.csv: rows of means over the time since the row before.",
    keys: &[
        key("name", Kind::Name, "Its name, and its file's.").required(),
        key("quantity", Kind::Word(words::<QuantityWord>), "What it measures.")
            .required()
            .also(&["type", "kind", "measure"]),
        key("position", a_vector(FAR, "m"), "A point, the foot of a column (which keeps three spacings off closed sides), or the middle of a rectangle.")
            .also(&["point", "center"]),
        key("body", Kind::Name, "The name of the body whose force is measured."),
        key(
            "normal",
            a_vector(FAR, ""),
            "Across a rectangle, of any length: what flows along it counts as positive.",
        )
        .also(&["direction"]),
        key("along", a_vector(FAR, ""), "A rectangle's first edge, of any length. Default: horizontal."),
        key("size", Kind::Numbers(2, range(1e-5, FAR, "m")), "Edge lengths of a rectangle."),
        key("min", a_vector(FAR, "m"), "Lower corner of a box of fluid. Default: all the fluid.").also(&["lower"]),
        key("max", a_vector(FAR, "m"), "Upper corner of a box of fluid. Default: all the fluid.").also(&["upper"]),
        key("interval", a_number(1e-6, 3600.0, "s"), "Time between two rows. Default: a tenth of a frame."),
    ],
};

static KEYFRAME: Table = Table {
    about: "A pose at a time; between keyframes the body moves smoothly, outside them it rests.",
    keys: &[
        key("time", a_number(0.0, 3600.0, "s"), "When.").required().also(&["t"]),
        key("position", a_vector(FAR, "m"), "Where the mesh's origin is. Default: the body's position."),
        key(
            "rotation",
            a_vector(36_000.0, "degrees"),
            "About x, then y, then z. Default: the body's rotation.",
        ),
    ],
};
