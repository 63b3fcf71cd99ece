//! What the engine shows.

use std::sync::Arc;

use splashdown::scene::Scene;
use splashdown::{BodyMesh, BodyState, Checkpoint, Stats};
use splashdown_gpu::Timings;
use splashdown_io::Mesh;

use super::{Drawn, Purpose};

/// A scene that is being simulated.
pub struct Opened {
    /// The scene.
    pub scene: Scene,
    /// The meshes of its bodies.
    pub bodies: Arc<[BodyMesh]>,
    /// What simulates it.
    pub device: String,
    /// Bytes in its buffers.
    pub memory: u64,
}

/// The fluid at one moment.
pub struct Snapshot {
    /// The scene that it shows.
    pub opened: Arc<Opened>,
    /// The simulation's account.
    pub stats: Stats,
    /// What is drawn.
    pub drawn: Arc<Drawn>,
    /// Where the bodies are.
    pub bodies: Vec<BodyState>,
    /// Mean height of the particles in m, a half second old at most; NaN where there are too many to look.
    pub mean_height: f32,
    /// Steps per second of wall time, lately.
    pub steps_per_second: f64,
    /// Simulated seconds per second of wall time, lately.
    pub speed: f64,
    /// Time per pass over the last half second, where it is wanted.
    pub timings: Arc<Timings>,
    /// Steps that `timings` are of.
    pub timed_steps: u64,
    /// True if the clock runs.
    pub playing: bool,
}

/// Something to tell the user.
pub enum Message {
    /// Something worth knowing.
    Note(String),
    /// What the scene cannot do; the simulation stands still.
    Failed(String),
    /// What cannot be changed; the simulation goes on as it was.
    Refused(String),
    /// The engine has ended by a fault of its own.
    Stopped,
    /// The surface, as [`Command::Export`](super::Command::Export) asked for it.
    Exported(Arc<Mesh>),
    /// What [`Command::Checkpoint`](super::Command::Checkpoint) asked for.
    Checkpoint(Box<Checkpoint>, Purpose),
    /// A body's distances are being computed: its name and how far, in [0, 1].
    Preparing(String, f32),
}
