//! Keys of bodies, emitters, sinks and probes.

use super::FAR;
use super::mesh::{MESH, POSITION, ROTATION, SCALE, UP};
use super::words::{MotionWord, OutletWord, QuantityWord, SinkWord};
use crate::scene::formula;
use crate::scene::spec::{Kind, Table, a_number, a_vector, key, range, words};
use crate::scene::things::BoundaryKind;

/// Maximum number of keyframes of a body.
const MAX_KEYFRAMES: usize = 4096;

pub(super) static BODY: Table = Table {
    about: "A solid body: static, scripted or dynamic.",
    keys: &[
        key("name", Kind::Name, "Name in messages and files.").required(),
        MESH.required().also(&["file", "model", "geometry_file", "shape"]),
        SCALE,
        UP,
        POSITION,
        ROTATION,
        key(
            "motion",
            Kind::Word(words::<MotionWord>),
            "Kind of motion. Default: static, or scripted if keyframe, move or turn is given.",
        )
        .also(&["type", "dynamic"]),
        key(
            "density",
            a_number(50.0, 30_000.0, "kg/m^3"),
            "Density of a dynamic body. The steps of wcsph and mueller2003 are shorter beside light and thin bodies.",
        )
            .default("500.0")
            .also(&["rho"]),
        key("velocity", a_vector(1000.0, "m/s"), "Initial velocity of a dynamic body.")
            .default("[0.0, 0.0, 0.0]"),
        key("angular_velocity", a_vector(1000.0, "rad/s"), "Initial angular velocity of a dynamic body.")
            .default("[0.0, 0.0, 0.0]"),
        key(
            "hinge",
            a_vector(FAR, ""),
            "Direction of an axis that holds a dynamic body, for example a wheel or a door.",
        )
        .also(&["axis", "axle"]),
        key("hinge_point", a_vector(FAR, "m"), "A point on the hinge axis. Default: the position of the body."),
        key(
            "motor_speed",
            a_number(-1000.0, 1000.0, "rad/s"),
            "Angular velocity about the hinge axis at which a motor turns the body; 0 brakes it. Default: no motor.",
        ),
        key("motor_torque", a_number(1e-9, 1e9, "N m"), "Maximum torque of the motor. Default: no limit."),
        key(
            "move",
            Kind::Texts(3, formula::ALLOWED),
            "Formulas of the time t in s for a displacement in m, for example [\"0.1*sin(2*pi*t)\", \"0\", \"0\"].",
        ),
        key(
            "turn",
            Kind::Texts(3, formula::ALLOWED),
            "Formulas of the time t in s for a rotation in degrees about the body's own x, then y, then z.",
        ),
        key("keyframe", Kind::Tables(&KEYFRAME, MAX_KEYFRAMES), "Poses at given times.")
            .also(&["keyframes"]),
        key("friction", a_number(0.0, 1.0, ""), "0: the fluid slips along the body; 1: it sticks to it.").default("0.0"),
        key("adhesion", a_number(0.0, 100.0, "m/s^2"), "Attraction of the fluid next to the body.")
            .default("0.0"),
        key(
            "contact_friction",
            a_number(0.0, 10.0, ""),
            "Coefficient of friction on solids. Two bodies have the mean of theirs; on a wall that of the body counts.",
        )
        .default("0.4"),
        key(
            "restitution",
            a_number(0.0, 1.0, ""),
            "Coefficient of restitution in collisions with solids: 0 does not bounce, 1 loses no energy. Combined as contact_friction.",
        )
        .default("0.2")
        .also(&["bounce", "bounciness", "elasticity"]),
        key("boundary", Kind::Word(words::<BoundaryKind>), "Boundary method.").default("\"map\""),
        key(
            "shell",
            Kind::Boolean,
            "Whether the mesh is a sheet with a thickness. Default: only if it is too open to have an inside.",
        ),
        key(
            "half_thickness",
            a_number(1e-6, 10.0, "m"),
            "Half the thickness of a shell. Default: half the particle spacing.",
        )
        .also(&["thickness"]),
        key("colour", Kind::Numbers(3, range(0.0, 1.0, "")), "Colour in pictures: linear red, green, blue.")
            .also(&["color"]),
    ],
};

pub(super) static EMITTER: Table = Table {
    about: "A nozzle that adds fluid.",
    keys: &[
        key("name", Kind::Name, "Name in messages.").required(),
        key("shape", Kind::Word(words::<OutletWord>), "Shape of the outlet.").default("\"disc\""),
        key("radius", a_number(1e-5, FAR, "m"), "Radius of a disc."),
        key(
            "size",
            Kind::Numbers(2, range(1e-5, FAR, "m")),
            "Edge lengths of a rectangle: horizontal, and perpendicular to it.",
        ),
        MESH,
        SCALE,
        UP,
        ROTATION,
        key("position", a_vector(FAR, "m"), "Centre of the outlet, or origin of the mesh.")
            .required()
            .also(&["center", "translation"]),
        key("direction", a_vector(FAR, ""), "Direction of the outflow, of any length.")
            .required()
            .also(&["normal"]),
        key("speed", a_number(1e-3, 1000.0, "m/s"), "Speed of the outflow.").required().also(&["velocity"]),
        key("start", a_number(0.0, 3600.0, "s"), "Start time.").default("0.0").also(&["start_time"]),
        key("end", a_number(0.0, 3600.0, "s"), "End time. Default: the end of the scene.")
            .also(&["end_time", "stop"]),
        key(
            "max_particles",
            Kind::Integer(range(1.0, 67_108_864.0, "")),
            "Maximum number of particles created.",
        )
        .also(&["cap"]),
    ],
};

pub(super) static SINK: Table = Table {
    about: "A region that removes fluid.",
    keys: &[
        key("name", Kind::Name, "Name in messages.").required(),
        key("shape", Kind::Word(words::<SinkWord>), "Shape of the region.").default("\"box\""),
        key("min", a_vector(FAR, "m"), "Lower corner of a box."),
        key("max", a_vector(FAR, "m"), "Upper corner of a box."),
        key("point", a_vector(FAR, "m"), "A point on the plane."),
        key(
            "normal",
            a_vector(FAR, ""),
            "Normal of the plane, of any length. Fluid on the opposite side is removed.",
        ),
        MESH,
        SCALE,
        UP,
        POSITION,
        ROTATION,
    ],
};

pub(super) static PROBE: Table = Table {
    about: "A measurement in every time step, written to probes/NAME.csv. Each row is the mean since the previous row; the pose and the velocity of a body are those at its time.",
    keys: &[
        key("name", Kind::Name, "Name of the probe and of its file.").required(),
        key("quantity", Kind::Word(words::<QuantityWord>), "Measured quantity.")
            .required()
            .also(&["type", "kind", "measure"]),
        key("position", a_vector(FAR, "m"), "Point of a pressure, foot of a height column (at least three spacings from closed sides), or centre of a flow rectangle.")
            .also(&["point", "center"]),
        key("body", Kind::Name, "Name of the body whose force or state is measured."),
        key(
            "normal",
            a_vector(FAR, ""),
            "Normal of a flow rectangle, of any length. Flow along it is positive.",
        )
        .also(&["direction"]),
        key("along", a_vector(FAR, ""), "Direction of the first edge of a flow rectangle. Default: horizontal."),
        key("size", Kind::Numbers(2, range(1e-5, FAR, "m")), "Edge lengths of a flow rectangle."),
        key("min", a_vector(FAR, "m"), "Lower corner of a box for fluid. Default: all fluid.").also(&["lower"]),
        key("max", a_vector(FAR, "m"), "Upper corner of a box for fluid. Default: all fluid.").also(&["upper"]),
        key("interval", a_number(1e-6, 3600.0, "s"), "Time between rows. Default: a tenth of a frame."),
    ],
};

static KEYFRAME: Table = Table {
    about: "A pose at a given time. The body moves smoothly between keyframes and rests before the first and after the last.",
    keys: &[
        key("time", a_number(0.0, 3600.0, "s"), "Time.").required().also(&["t"]),
        key(
            "position",
            a_vector(FAR, "m"),
            "Position of the mesh's origin. Default: the position of the body.",
        ),
        key(
            "rotation",
            a_vector(36_000.0, "degrees"),
            "Rotation about x, then y, then z. Default: the rotation of the body.",
        ),
    ],
};
