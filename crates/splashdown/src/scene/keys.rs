//! Every key of the scene file, declared once: the reader, the JSON schema, the reference and the messages come from here.

use super::choice::{Choice, choices};
use super::materials::MATERIALS;
use super::spec::{Key, Kind, Table, Word, a_number, a_vector, key, range, words};
use super::things::{BoundaryKind, UpAxis};
use super::types::{
    ColourBy, DensityMode, Format, KernelKind, Method, NegativePressure, PictureKind, Sort, SurfaceTension,
};

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
/// Most keyframes of a body.
const MAX_KEYFRAMES: usize = 4096;
/// Most blocks in a scene; most meshes of fluid, and most files.
const MAX_BLOCKS: usize = 256;

choices! {
    /// A side of the domain.
    Side {
        /// The side at min x.
        XMin = "x_min",
        /// The side at max x.
        XMax = "x_max",
        /// The floor.
        YMin = "y_min",
        /// The lid.
        YMax = "y_max",
        /// The side at min z.
        ZMin = "z_min",
        /// The side at max z.
        ZMax = "z_max",
    }
    /// The word for an emitter's outlet.
    OutletWord {
        /// Needs `radius`.
        Disc = "disc",
        /// Needs `size`.
        Rectangle = "rectangle",
        /// The outline of a closed mesh, cut through its origin across the direction: needs `mesh`.
        Mesh = "mesh",
    }
    /// The word for a sink's shape.
    SinkWord {
        /// Inside a box: needs `min` and `max`.
        Box = "box",
        /// Behind a plane: needs `point` and `normal`.
        Below = "below",
        /// Inside a closed mesh: needs `mesh`.
        Mesh = "mesh",
    }
    /// The word for what a probe measures.
    QuantityWord {
        /// Pressure in Pa at a point: needs `position`.
        Pressure = "pressure",
        /// Height of the fluid in m above a point, in the column over it: needs `position`.
        Height = "height",
        /// Force in N and torque in N m of the fluid on a body: needs `body`.
        Force = "force",
        /// Volume in m^3/s through a rectangle: needs `position`, `normal` and `size`.
        Flow = "flow",
        /// Volume in m^3, kinetic and potential energy in J and momentum in N s of all the fluid, or of what is between `min` and `max`,
        /// at the end of every frame.
        Fluid = "fluid",
    }
    /// The word for a body's motion.
    MotionWord {
        /// It stands still.
        Static = "static",
        /// It moves as keyframes or formulas say.
        Scripted = "scripted",
        /// The fluid, gravity and contacts move it.
        Dynamic = "dynamic",
    }
    /// The word for a block's shape.
    ShapeWord {
        /// An axis-aligned box: needs `position` and `size`.
        Box = "box",
        /// A ball: needs `center` and `radius`.
        Sphere = "sphere",
    }
}

impl Side {
    /// Its place in [`super::Domain::closed`]: axis and side.
    pub fn place(self) -> (usize, usize) {
        let index = Self::ALL.iter().position(|(side, ..)| *side == self).unwrap_or(0);
        (index / 2, index % 2)
    }
}

fn materials() -> Vec<Word> {
    MATERIALS.iter().map(|known| (known.name, known.about)).collect()
}

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

static FLUID: Table = Table {
    about: "The fluid and where it starts.",
    keys: &[
        key(
            "particle_spacing",
            a_number(1e-5, 10.0, "m"),
            "Distance of neighbouring particles: the resolution.",
        )
        .required()
        .also(&["spacing", "dx", "dp", "resolution", "particle_radius", "particle_size"]),
        key("material", Kind::Word(materials), "A liquid with its measured properties at 20 °C.")
            .default("\"water\""),
        key("density", a_number(1.0, 30_000.0, "kg/m^3"), "Density at rest, in place of the material's.")
            .also(&["rest_density", "rho", "rho0", "density0"]),
        key("viscosity", a_number(0.0, 100.0, "m^2/s"), "Kinematic viscosity, in place of the material's.")
            .also(&["nu", "kinematic_viscosity", "mu"]),
        key("surface_tension", a_number(0.0, 10.0, "N/m"), "Surface tension, in place of the material's.")
            .also(&["sigma"]),
        key(
            "block",
            Kind::Tables(&BLOCK, MAX_BLOCKS),
            "Pieces of fluid at the start; at least one unless a mesh, a file or an emitter brings fluid.",
        )
        .also(&["blocks"]),
        key(
            "mesh",
            Kind::Tables(&FLUID_MESH, MAX_BLOCKS),
            "Closed meshes that are filled with fluid at the start.",
        )
        .also(&["meshes", "shape", "fill"]),
        key("file", Kind::Tables(&FLUID_FILE, MAX_BLOCKS), "Files of particles that are there at the start.")
            .also(&["files", "particles"]),
    ],
};

static BLOCK: Table = Table {
    about: "A piece of fluid at the start.",
    keys: &[
        key("shape", Kind::Word(words::<ShapeWord>), "A box (position, size) or a sphere (center, radius).")
            .default("\"box\""),
        key("position", a_vector(FAR, "m"), "Lower corner of a box.").also(&["min", "corner", "origin"]),
        key("size", Kind::Numbers(3, range(1e-5, FAR, "m")), "Edge lengths of a box.")
            .also(&["max", "extent"]),
        key("center", a_vector(FAR, "m"), "Centre of a sphere.").also(&["centre"]),
        key("radius", a_number(1e-5, FAR, "m"), "Radius of a sphere."),
        key("velocity", a_vector(1000.0, "m/s"), "Velocity at the start.").default("[0.0, 0.0, 0.0]"),
    ],
};

static FLUID_MESH: Table = Table {
    about: "A closed mesh filled with fluid at the start. Where it overlaps blocks, or meshes before it, those keep the room.",
    keys: &[
        MESH.required(),
        SCALE,
        UP,
        POSITION,
        ROTATION,
        key("velocity", a_vector(1000.0, "m/s"), "Velocity at the start.").default("[0.0, 0.0, 0.0]"),
    ],
};

static FLUID_FILE: Table = Table {
    about: "Particles of a file, as they lie, at the start: those of a frame of an earlier run, for example. Where they overlap blocks, meshes \
            or files before them, those keep the room.",
    keys: &[
        key(
            "file",
            Kind::Text("a file (.ply, .npy, .npz, .vtk, .vtu, .vtp, .bgeo, .xyz) beside the scene file"),
            "The particles.",
        )
        .required()
        .also(&["path", "name", "particles"]),
        SCALE,
        key("position", a_vector(FAR, "m"), "Where the file's origin lies.")
            .default("[0.0, 0.0, 0.0]")
            .also(&["translation", "offset"]),
        key(
            "rotation",
            a_vector(36_000.0, "degrees"),
            "Turned about the file's x, then y, then z, velocities too.",
        )
        .default("[0.0, 0.0, 0.0]"),
        key(
            "velocity",
            a_vector(1000.0, "m/s"),
            "Added to the file's velocities, which are zero where it has none.",
        )
        .default("[0.0, 0.0, 0.0]"),
    ],
};

/// The mesh of anything that has one.
const MESH: Key = key(
    "mesh",
    Kind::Text("a file (.obj, .stl, .ply, .gltf, .glb) beside the scene file, or a model's name"),
    "Its triangles: a file, or one of the models that come with the program, such as lighthouse; a name that is none is answered with the list.",
)
.also(&["file", "model", "geometry_file"]);
const SCALE: Key = key(
    "scale",
    Kind::Scale(range(1e-6, 1e6, "")),
    "Metres per unit of the file, or the file's unit: \"mm\" is 0.001.",
)
.default("1.0")
.also(&["units", "unit"]);
const UP: Key = key("up", Kind::Word(words::<UpAxis>), "Which axis of the file points up.").default("\"y\"");
const POSITION: Key = key("position", a_vector(FAR, "m"), "Where the mesh's origin lies.")
    .default("[0.0, 0.0, 0.0]")
    .also(&["translation", "center"]);
const ROTATION: Key = key("rotation", a_vector(36_000.0, "degrees"), "Turned about x, then y, then z.")
    .default("[0.0, 0.0, 0.0]");

static BODY: Table = Table {
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
            Kind::Texts(3, super::formula::ALLOWED),
            "Formulas of t added to the position, in m: [\"0.1*sin(2*pi*t)\", \"0\", \"0\"].",
        ),
        key(
            "turn",
            Kind::Texts(3, super::formula::ALLOWED),
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

static EMITTER: Table = Table {
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

static SINK: Table = Table {
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

static PROBE: Table = Table {
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

static SOLVER: Table = Table {
    about: "How the fluid is computed.",
    keys: &[
        key("method", Kind::Word(words::<Method>), "The method.")
            .default("\"wcsph\"")
            .also(&["type", "name"]),
        key("kernel", Kind::Word(words::<KernelKind>), "The kernel of wcsph.").default("\"wendland_c2\""),
        key(
            "support_ratio",
            a_number(1.5, 4.0, ""),
            "Support radius of the kernel over the particle spacing.",
        )
        .default("2.0")
        .also(&["support_radius", "smoothing_length", "h"]),
        key(
            "density",
            Kind::Word(words::<DensityMode>),
            "How the density is found; continuity is for wcsph.",
        )
        .default("\"summation\""),
        key(
            "negative_pressure",
            Kind::Word(words::<NegativePressure>),
            "What happens to pressures below zero. Default: clamp with summation, keep with continuity.",
        ),
        key(
            "sound_speed",
            a_number(1e-3, 10_000.0, "m/s"),
            "Speed of sound. Default: ten times the largest speed to expect.",
        )
        .also(&["c0", "c", "speed_of_sound"]),
        key(
            "stiffness",
            a_number(1e-6, 1e12, ""),
            "Instead of sound_speed: Tait's constant in Pa (wcsph) or k in m^2/s^2 (mueller2003).",
        )
        .also(&["k"]),
        key(
            "exponent",
            a_number(1.0, 10.0, ""),
            "Exponent of the equation of state. Default: 7 for wcsph, 1 for mueller2003.",
        )
        .also(&["gamma"]),
        key("artificial_viscosity", a_number(0.0, 2.0, ""), "Monaghan's factor alpha; wcsph.")
            .default("0.05")
            .also(&["alpha"]),
        key("density_diffusion", a_number(0.0, 1.0, ""), "The factor delta of delta-SPH; with continuity.")
            .default("0.1")
            .also(&["delta"]),
        key(
            "surface_tension",
            Kind::Word(words::<SurfaceTension>),
            "The model of surface tension: akinci2013 for wcsph, mueller2003 for mueller2003.",
        )
        .default("\"none\""),
        key("wall_friction", a_number(0.0, 1.0, ""), "0: the fluid slips along walls; 1: it sticks.")
            .default("0.0"),
        key(
            "cfl_factor",
            a_number(0.01, 1.0, ""),
            "Time step as a part of half the support radius over the speed of sound.",
        )
        .default("0.3")
        .also(&["cfl", "courant"]),
        key("max_dt", a_number(1e-9, 1.0, "s"), "Longest time step.").default("0.005").also(&[
            "dt",
            "time_step",
            "timestep",
        ]),
        key("min_dt", a_number(1e-12, 1.0, "s"), "Shortest time step.").default("1e-7"),
        key("sort", Kind::Word(words::<Sort>), "How particles are sorted into cells.")
            .default("\"counting\""),
    ],
};

static SURFACE: Table = Table {
    about: "How the fluid's surface is extracted.",
    keys: &[
        key("enabled", Kind::Boolean, "Whether it is extracted.").default("true"),
        key(
            "cell_size",
            a_number(1e-6, 10.0, "m"),
            "Edge of a marching-cubes cell. Default: half the particle spacing.",
        )
        .also(&["resolution", "cube_size"]),
        key("iso_level", a_number(0.05, 0.95, ""), "Where the surface lies, as a part of the inner density.")
            .default("0.6")
            .also(&["threshold", "iso", "isovalue"]),
        key("smoothing_iterations", Kind::Integer(range(0.0, 100.0, "")), "Rounds of smoothing.")
            .default("5")
            .also(&["smoothing"]),
        key(
            "support_ratio",
            a_number(1.0, 6.0, ""),
            "Support radius of the field over the particle spacing.",
        )
        .default("2.0"),
    ],
};

static FOAM: Table = Table {
    about: "Whether a splash makes foam, spray and bubbles, and how much (Ihmsen et al. 2012). For looks; the water does not feel them.",
    keys: &[
        key("enabled", Kind::Boolean, "Whether it does.").default("false"),
        key(
            "trapped_air",
            a_number(0.0, 1e5, "1/s"),
            "Particles of foam per second from each particle of water that traps as much air as it can: where water meets water.",
        )
        .default("200.0")
        .also(&["k_ta", "air"]),
        key(
            "wave_crest",
            a_number(0.0, 1e5, "1/s"),
            "Particles of foam per second from each particle of a breaking wave's crest.",
        )
        .default("1000.0")
        .also(&["k_wc", "crest"]),
        key(
            "trapped_air_limits",
            Kind::Numbers(2, range(0.0, 10.0, "")),
            "Speed at which water meets water, over the scene's reference speed: none below the first, all above the second.",
        )
        .default("[0.07, 0.25]"),
        key(
            "wave_crest_limits",
            Kind::Numbers(2, range(0.0, 10.0, "")),
            "Curvature of crests: none below the first, all above the second.",
        )
        .default("[0.1, 0.5]"),
        key(
            "speed_limits",
            Kind::Numbers(2, range(0.0, 10.0, "")),
            "Speed of the water over the scene's reference speed: no foam below the first, all above the second.",
        )
        .default("[0.2, 0.7]")
        .also(&["energy_limits"]),
        key(
            "lifetime",
            Kind::Numbers(2, range(0.0, 3600.0, "s")),
            "Shortest and longest time until foam on the surface has dissolved.",
        )
        .default("[2.0, 5.0]"),
        key("buoyancy", a_number(0.0, 100.0, ""), "Lift of bubbles in multiples of gravity.").default("2.0"),
        key(
            "drag",
            a_number(1.0, 1e5, "1/s"),
            "How quickly bubbles take the water's velocity; they rise at buoyancy times gravity over it.",
        )
        .default("80.0"),
        key(
            "max_particles",
            Kind::Integer(range(1.0, 1e9, "")),
            "Most particles of foam, spray and bubbles. Default: four per particle of water, four million at most.",
        )
        .also(&["limit", "max", "count"]),
    ],
};

static CAMERA: Table = Table {
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

static OUTPUT: Table = Table {
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
