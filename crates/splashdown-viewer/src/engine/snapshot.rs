//! The output of the engine.

use std::sync::Arc;

use splashdown::scene::Scene;
use splashdown::{BodyMesh, BodyState, Checkpoint, Stats};
use splashdown_gpu::Timings;
use splashdown_io::Mesh;

use super::{Drawn, Purpose};

/// The scene being simulated.
#[derive(Clone)]
pub struct Opened {
    /// The scene.
    pub scene: Scene,
    /// The meshes of its bodies.
    pub bodies: Arc<[BodyMesh]>,
    /// The simulating device.
    pub device: String,
    /// Bytes in its buffers, including those of the surface and the foam.
    pub memory: u64,
}

/// The fluid at one moment.
pub struct Snapshot {
    /// The scene.
    pub opened: Arc<Opened>,
    /// The statistics of the simulation.
    pub stats: Stats,
    /// The buffers to draw.
    pub drawn: Arc<Drawn>,
    /// The states of the bodies.
    pub bodies: Vec<BodyState>,
    /// Mean height of the particles in m, at most half a second old; NaN if there are too many to compute it.
    pub mean_height: f32,
    /// Recent steps per second of wall time.
    pub steps_per_second: f64,
    /// Recent simulated seconds per second of wall time.
    pub speed: f64,
    /// Time per pass over the last half second, if enabled.
    pub timings: Arc<Timings>,
    /// Number of steps in `timings`.
    pub timed_steps: u64,
    /// Whether the simulation is running, not paused.
    pub playing: bool,
}

/// A message to the window.
pub enum Message {
    /// Information.
    Note(String),
    /// The simulation failed and is paused.
    Failed(String),
    /// A change was refused; the simulation continues without it.
    Refused(String),
    /// The engine has panicked.
    Stopped,
    /// The surface requested by [`Command::Export`](super::Command::Export).
    Exported(Arc<Mesh>),
    /// The checkpoint requested by [`Command::Checkpoint`](super::Command::Checkpoint).
    Checkpoint(Box<Checkpoint>, Purpose),
    /// The distance field of a body is being computed: its name and the completed fraction, in [0, 1].
    Preparing(String, f32),
}
