//! Smoothed-particle hydrodynamics on any GPU, and fast without one: scenes, solvers and the surface of the fluid.
//!
//! ```
//! use splashdown::{Device, Simulation, scene::Scene};
//! # let text = include_str!("../../../scenes/dam-break-small.toml");
//! let scene = Scene::parse(text, "dam-break-small.toml")?; // or Scene::load(path)
//! let mut simulation = Simulation::new(&scene, &Device::Auto)?; // the best GPU, else the CPU
//! let stats = simulation.advance(0.002)?; // as many steps as stability asks for
//! println!("{} steps, {} particles", stats.steps, simulation.particles()?.positions.len());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Whole runs, with the surface of every frame, come as one stream of events: [`Run`].
//!
//! A step is a list of passes ([`schemes`]), each of which is one folder ([`mod@passes`]) with its equation, its
//! WGSL and its Rust; the list runs on the GPU or on the CPU ([`splashdown_gpu::Executor`]).

pub mod bodies;
pub mod boundary;
pub mod cells;
mod checkpoint;
pub mod coupling;
mod device;
mod error;
pub mod flow;
pub mod foam;
pub mod kernel;
pub(crate) mod marching_cubes;
mod memory;
pub mod models;
pub mod mouse_force;
pub mod passes;
pub mod probes;
mod reconstruct;
mod run;
pub mod sample;
pub mod scene;
pub mod schemes;
pub mod simd;
mod simulation;
pub mod solid;
pub mod state;
mod stats;
pub mod surface;

pub use bodies::{BodyMesh, BodyState};
pub use checkpoint::{Checkpoint, CheckpointError};
pub use device::Device;
pub use error::SimulationError;
pub use foam::{Diffuse, DiffuseKind, DiffuseParticles, Foam, FoamState, KeptFoam};
pub use memory::{check_particles, largest_particle_count, memory_forecast, memory_forecast_of};
pub use mouse_force::MouseForce;
pub use reconstruct::reconstruct;
pub use run::{Event, Frame, Progress, ProgressFn, Run, RunOptions, Started, Summary};
pub use scene::{Scene, SceneBuilder, SceneErrors};
pub use simulation::Simulation;
pub use state::Fields;
pub use stats::Stats;
pub use surface::{Surface, SurfaceParams, SurfaceStats};
pub use {glam, splashdown_gpu::Executor, splashdown_io::Mesh, splashdown_io::Particles};

/// Every pass of this crate.
pub fn passes() -> Vec<&'static splashdown_gpu::PassDesc> {
    [
        state::passes(),
        cells::passes(),
        passes::passes(),
        bodies::passes(),
        flow::passes(),
        foam::passes(),
        mouse_force::passes(),
        probes::passes(),
        surface::passes(),
    ]
    .concat()
}

/// The examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
