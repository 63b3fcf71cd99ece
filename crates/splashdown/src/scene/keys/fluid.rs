//! Keys of `[fluid]`.

use super::FAR;
use super::mesh::{MESH, POSITION, ROTATION, SCALE, UP};
use super::words::ShapeWord;
use crate::scene::materials::MATERIALS;
use crate::scene::spec::{Kind, Table, Word, a_number, a_vector, key, range, words};

/// Most blocks in a scene; most meshes of fluid, and most files.
const MAX_BLOCKS: usize = 256;

fn materials() -> Vec<Word> {
    MATERIALS.iter().map(|known| (known.name, known.about)).collect()
}
pub(super) static FLUID: Table = Table {
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
