//! Keys of `[fluid]`.

use super::FAR;
use super::mesh::{MESH, POSITION, ROTATION, SCALE, UNIFORM_SCALE, UP};
use super::words::ShapeWord;
use crate::scene::materials::MATERIALS;
use crate::scene::spec::{Kind, Table, Word, a_number, a_vector, key, range, words};
use crate::scene::types::InitialPressure;

/// Maximum number of blocks, of fluid meshes, and of fluid files in a scene.
const MAX_BLOCKS: usize = 256;

fn materials() -> Vec<Word> {
    MATERIALS.iter().map(|known| (known.name, known.about)).collect()
}
pub(super) static FLUID: Table = Table {
    about: "The fluid and its initial shape.",
    keys: &[
        key(
            "particle_spacing",
            a_number(1e-5, 10.0, "m"),
            "Distance between neighbouring particles: the resolution.",
        )
        .required()
        .also(&["spacing", "dx", "dp", "resolution", "particle_radius", "particle_size"]),
        key("material", Kind::Word(materials), "A liquid with its measured properties at 20 °C.")
            .default("\"water\""),
        key("density", a_number(1.0, 30_000.0, "kg/m^3"), "Rest density. Default: that of the material.")
            .also(&["rest_density", "rho", "rho0", "density0"]),
        key(
            "viscosity",
            a_number(0.0, 100.0, "m^2/s"),
            "Kinematic viscosity. Default: that of the material.",
        )
        .also(&["nu", "kinematic_viscosity", "mu"]),
        key("surface_tension", a_number(0.0, 10.0, "N/m"), "Surface tension. Default: that of the material.")
            .also(&["sigma"]),
        key(
            "block",
            Kind::Tables(&BLOCK, MAX_BLOCKS),
            "Fluid at the start; at least one block unless a mesh, a file or an emitter provides fluid.",
        )
        .also(&["blocks"]),
        key(
            "initial_pressure",
            Kind::Word(words::<InitialPressure>),
            "Pressure at the start of boxes at rest that stand on a closed side, if gravity is along an axis; other fluid starts without pressure.",
        )
        .default("\"hydrostatic\""),
        key("mesh", Kind::Tables(&FLUID_MESH, MAX_BLOCKS), "Closed meshes filled with fluid at the start.")
            .also(&["meshes", "shape", "fill"]),
        key("file", Kind::Tables(&FLUID_FILE, MAX_BLOCKS), "Particle files that provide fluid at the start.")
            .also(&["files", "particles"]),
    ],
};

static BLOCK: Table = Table {
    about: "A box or ball of fluid at the start.",
    keys: &[
        key("shape", Kind::Word(words::<ShapeWord>), "Shape of the block.").default("\"box\""),
        key("position", a_vector(FAR, "m"), "Lower corner of a box.").also(&["min", "corner", "origin"]),
        key("size", Kind::Numbers(3, range(1e-5, FAR, "m")), "Edge lengths of a box.")
            .also(&["max", "extent"]),
        key("center", a_vector(FAR, "m"), "Centre of a sphere.").also(&["centre"]),
        key("radius", a_number(1e-5, FAR, "m"), "Radius of a sphere."),
        key("velocity", a_vector(1000.0, "m/s"), "Initial velocity.").default("[0.0, 0.0, 0.0]"),
    ],
};

static FLUID_MESH: Table = Table {
    about: "A closed mesh filled with fluid at the start. Blocks and earlier meshes have priority where they overlap.",
    keys: &[
        MESH.required(),
        SCALE,
        UP,
        POSITION,
        ROTATION,
        key("velocity", a_vector(1000.0, "m/s"), "Initial velocity.").default("[0.0, 0.0, 0.0]"),
        key(
            "shell",
            Kind::Boolean,
            "false fills a mesh in spite of large holes. Default: such a mesh is an error, because it has no inside.",
        ),
    ],
};

static FLUID_FILE: Table = Table {
    about: "Particles of a file at their positions, for example a frame of an earlier run. Blocks, meshes and earlier files have priority where \
            they overlap.",
    keys: &[
        key(
            "file",
            Kind::Text("a file (.ply, .npy, .npz, .vtk, .vtu, .vtp, .bgeo, .xyz) beside the scene file"),
            "Particle file.",
        )
        .required()
        .also(&["path", "name", "particles"]),
        UNIFORM_SCALE,
        key("position", a_vector(FAR, "m"), "Position of the file's origin.")
            .default("[0.0, 0.0, 0.0]")
            .also(&["translation", "offset"]),
        key(
            "rotation",
            a_vector(36_000.0, "degrees"),
            "Rotation of positions and velocities about the file's x, then y, then z.",
        )
        .default("[0.0, 0.0, 0.0]"),
        key(
            "velocity",
            a_vector(1000.0, "m/s"),
            "Added to the velocities of the file; a file without velocities has zero velocities.",
        )
        .default("[0.0, 0.0, 0.0]"),
    ],
};
