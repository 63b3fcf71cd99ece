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
//! | compute all frames of a scene, with their surfaces | [`Run`], which emits [`Event`]s; [`run`] |
//! | read foam and probes | [`foam`], [`probes`] |
//! | know whether the results are plausible | [`monitor`] |
//! | stop and continue | [`Checkpoint`] |
//! | choose where it runs | [`Device`], [`gpu`] |
//! | reconstruct a surface | [`reconstruct()`], or [`Surface`] on the device of a simulation; [`surface`] |
//! | tell errors apart | [`SimulationError`], [`error`] |
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
//! checkpoint surface schemes monitor
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
pub mod error;
mod fingerprint;
#[doc(hidden)]
pub mod flow;
pub mod foam;
#[doc(hidden)]
pub mod kernel;
pub(crate) mod marching_cubes;
mod memory;
#[doc(hidden)]
pub mod models;
pub mod monitor;
#[doc(hidden)]
pub mod mouse_force;
mod pairs;
#[doc(hidden)]
pub mod passes;
pub mod probes;
mod reconstruct;
pub mod run;
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
pub use checkpoint::Checkpoint;
pub use device::Device;
pub use error::SimulationError;
#[doc(hidden)]
pub use memory::{
    check_particles, largest_particle_count, memory_forecast, memory_forecast_of, neighbour_search_forecast,
};
pub use mouse_force::MouseForce;
pub use reconstruct::reconstruct;
pub use run::{Event, Run, RunOptions};
pub use scene::{Scene, SceneBuilder};
#[doc(hidden)]
pub use schemes::longest_step;
pub use simulation::Simulation;
pub use simulation::{InitialDensity, Packing};
#[doc(hidden)]
pub use simulation::{initial_packing, inventory};
pub use stats::Stats;
pub use surface::{Surface, SurfaceParams};
pub use {glam, splashdown_io::Mesh, splashdown_io::Particles};

/// The device of a simulation, from the crate `splashdown-gpu`.
pub mod gpu {
    pub use splashdown_gpu::{Executor, Gpu, PassTime, Timings};
}

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
