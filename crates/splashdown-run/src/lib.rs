//! A Splashdown run and its files.
//!
//! [`splashdown::Run`] computes frames. This crate turns them into an output folder: particles, meshes,
//! checkpoints, tables of probes and bodies, pictures, films and the report `run.json`. The command line and the window share it.
//! It prints nothing: a [`Reporter`] receives every message.
//!
//! ```
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use splashdown::scene::{Scene, presets};
//! use splashdown_run::{RunEnd, RunRequest, RunSettings, Stop, run};
//!
//! let (name, text) = presets()[1]; // or Scene::load("my.toml")
//! let scene = Scene::parse(text, name)?;
//! let mut settings = RunSettings::default();
//! settings.frames = Some(1);
//! settings.pictures = Some(Vec::new());
//! # settings.device = Some(splashdown::Device::Cpu);
//! let mut request = RunRequest::new(scene, settings);
//! # let folder = tempfile::tempdir()?;
//! # let out = folder.path().to_owned();
//! request.out = Some(out.clone());
//! let outcome = run(request, &mut (), &|| Stop::No)?;
//! assert!(matches!(outcome.end, RunEnd::Finished(_)));
//! assert!(out.join("mesh/surface_0001.ply").exists() && out.join("run.json").exists());
//! # Ok(())
//! # }
//! ```
//!
//! # Guarantees
//!
//! * Every file is complete or absent.
//! * A [`RunRequest::resume`]d run is bit-identical to an uninterrupted one on the same device.
//! * At most one run at a time writes into a folder.

#![cfg_attr(
    target_arch = "wasm32",
    expect(dead_code, unused_imports, reason = "a web page exports single files and has no output folder")
)]

pub mod appearance;
mod body_meshes;
mod body_table;
mod checkpoints;
mod error;
pub mod export;
pub mod films;
mod folder;
mod frames;
mod lock;
mod outcome;
#[cfg(not(target_arch = "wasm32"))]
mod pictures;
#[cfg(not(target_arch = "wasm32"))]
mod playback;
mod recorder;
mod report;
mod reporter;
mod request;
pub mod sequence;
#[cfg(not(target_arch = "wasm32"))]
mod session;
mod settings;
mod tables;

pub use checkpoints::{FoundCheckpoint, find_checkpoint, recent_checkpoints};
pub use error::RunError;
pub use folder::RunFolder;
pub use frames::{CompleteFrame, FrameSummary};
pub use outcome::{PictureTimings, RunEnd, RunOutcome};
#[cfg(not(target_arch = "wasm32"))]
pub use pictures::{Beside, FinishedFrame, FinishedRun, Orbit, Painter, picture_memory};
#[cfg(not(target_arch = "wasm32"))]
pub use playback::{PlayedFrame, RunFrames, reported_scene, scene_of_run};
pub use recorder::Recorder;
pub use report::{PassNumbers, pass_numbers};
pub use reporter::{Reporter, Stop};
pub use request::RunRequest;
#[cfg(not(target_arch = "wasm32"))]
pub use session::{Session, run};
pub use settings::RunSettings;
pub use splashdown_render::MemoryForecast;
