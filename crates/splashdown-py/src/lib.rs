//! The extension module of the Python package `splashdown`.
//!
//! It translates Python objects into those of the Rust crates and back; everything that needs no Rust is written in
//! Python (`python/splashdown`). Long computations release the interpreter lock. Arrays that Python receives are views
//! of the memory of immutable Rust objects, so nothing is copied; arrays that Python gives are checked and copied.

mod argument;
mod arrays;
mod bodies;
mod busy;
mod checkpoint;
mod command;
mod errors;
mod files;
mod foam;
mod mesh;
mod painter;
mod particles;
mod progress;
mod recording;
mod run;
mod scene;
mod simulation;
mod stats;
mod surface;

/// The classes and functions of the package.
#[pyo3::pymodule]
mod _splashdown {
    #[pymodule_export]
    use crate::bodies::Body;
    #[pymodule_export]
    use crate::checkpoint::Checkpoint;
    #[pymodule_export]
    use crate::command::run_command;
    #[pymodule_export]
    use crate::files::{
        mesh_formats, particle_formats, read_mesh, read_particles, write_mesh, write_particles,
    };
    #[pymodule_export]
    use crate::foam::Foam;
    #[pymodule_export]
    use crate::mesh::Mesh;
    #[pymodule_export]
    use crate::painter::Painter;
    #[pymodule_export]
    use crate::particles::Particles;
    #[pymodule_export]
    use crate::progress::Progress;
    #[pymodule_export]
    use crate::recording::run;
    #[pymodule_export]
    use crate::run::{Frame, Run};
    #[pymodule_export]
    use crate::scene::Scene;
    #[pymodule_export]
    use crate::simulation::Simulation;
    #[pymodule_export]
    use crate::stats::Stats;
    #[pymodule_export]
    use crate::surface::surface;

    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "the name in Python")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
