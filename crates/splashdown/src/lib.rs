//! Smoothed-particle hydrodynamics (SPH) on any GPU, and on the CPU where there is none.
//!
//! Simulate, and read the particles as arrays:
//!
//! ```
//! use splashdown::{Device, Scene, Simulation};
//! let scene = Scene::builder("column", 0.5) // or Scene::load("my.toml")
//!     .domain([0.0, 0.0, 0.0], [1.6, 1.0, 0.5])
//!     .particle_spacing(0.1)
//!     .block([0.0, 0.0, 0.0], [0.4, 0.6, 0.5])
//!     .build()?;
//! let mut simulation = Simulation::new(&scene, &Device::Auto)?; // the best GPU, else the CPU
//! simulation.advance(0.01)?; // seconds
//! let positions: Vec<[f32; 3]> = simulation.particles()?.positions; // m
//! # assert_eq!(positions.len(), 120);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Reconstruct a closed triangle mesh from your own particles:
//!
//! ```
//! use splashdown::{Device, SurfaceParams, reconstruct};
//! let points = vec![[0.0_f32; 3], [0.05, 0.0, 0.0], [0.0, 0.05, 0.0]]; // m
//! let (mesh, _) = reconstruct(&points, &SurfaceParams::new(0.05), &Device::Auto)?;
//! println!("{} triangles", mesh.triangles.len());
//! # Ok::<(), splashdown::SimulationError>(())
//! ```
//!
//! | to | use |
//! |---|---|
//! | describe what to simulate | [`Scene`], [`Scene::builder`], [`scene`] |
//! | advance a simulation and read its state | [`Simulation`], [`Stats`], [`Particles`] |
//! | compute all frames of a scene, with their surfaces | [`Run`], which emits [`Event`]s |
//! | stop and continue | [`Checkpoint`] |
//! | choose where it runs | [`Device`] |
//! | reconstruct a surface | [`reconstruct()`], or [`Surface`] on the device of a simulation |
//!
//! Lengths are in metres, times in seconds, masses in kilograms; y is up. Modules without documentation here are
//! internals: they are public for the other crates of this workspace, and may change in any release.
//!
//! # Modules
//!
//! A module imports modules of lower lines only, which a test of `xtask` checks.
//!
//! ```text
//! run
//! simulation
//! memory reconstruct
//! error
//! checkpoint surface schemes
//! check foam
//! sample flow probes
//! bodies mouse_force passes
//! solid coupling pairs scene
//! boundary cells models
//! state kernel marching_cubes
//! simd fingerprint stats device
//! ```

#[doc(hidden)]
pub mod bodies;
#[doc(hidden)]
pub mod boundary;
#[doc(hidden)]
pub mod cells;
#[doc(hidden)]
pub mod check;
mod checkpoint;
#[doc(hidden)]
pub mod coupling;
mod device;
mod error;
mod fingerprint;
#[doc(hidden)]
pub mod flow;
#[doc(hidden)]
pub mod foam;
#[doc(hidden)]
pub mod kernel;
pub(crate) mod marching_cubes;
mod memory;
#[doc(hidden)]
pub mod models;
#[doc(hidden)]
pub mod mouse_force;
mod pairs;
#[doc(hidden)]
pub mod passes;
#[doc(hidden)]
pub mod probes;
mod reconstruct;
mod run;
#[doc(hidden)]
pub mod sample;
pub mod scene;
#[doc(hidden)]
pub mod schemes;
#[doc(hidden)]
pub mod simd;
mod simulation;
#[doc(hidden)]
pub mod solid;
#[doc(hidden)]
pub mod state;
mod stats;
pub mod surface;
#[cfg(test)]
mod work;

pub use bodies::{BodyMesh, BodyState};
pub use checkpoint::{Checkpoint, CheckpointError};
pub use device::Device;
pub use error::SimulationError;
#[doc(hidden)]
pub use foam::{Diffuse, FoamState, KeptFoam};
pub use foam::{DiffuseKind, DiffuseParticles, Foam};
#[doc(hidden)]
pub use memory::{check_particles, largest_particle_count, memory_forecast, memory_forecast_of};
pub use mouse_force::MouseForce;
pub use reconstruct::reconstruct;
pub use run::{Event, Frame, Progress, ProgressFn, Run, RunOptions, Started, Summary};
pub use scene::{Scene, SceneBuilder, SceneErrors};
pub use simulation::Simulation;
#[doc(hidden)]
pub use simulation::inventory;
#[doc(hidden)]
pub use state::Fields;
pub use stats::Stats;
pub use surface::{Surface, SurfaceParams, SurfaceStats};
pub use {glam, splashdown_gpu::Executor, splashdown_io::Mesh, splashdown_io::Particles};

/// All passes of this crate, for the shader validation and the tests.
#[doc(hidden)]
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

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
