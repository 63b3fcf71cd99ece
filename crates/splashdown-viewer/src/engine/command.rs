//! Commands from the window to the engine.

use glam::Vec3;
use splashdown::scene::Scene;
use splashdown::{Checkpoint, MouseForce};

/// Which device simulates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Simulate {
    /// The one that draws.
    WhereDrawn,
    /// The CPU, which is about twelve times as fast as a software driver (`docs/performance.md`).
    OnCpu,
}

/// A free body held at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grip {
    /// Number of the body, in the order of the scene.
    pub body: usize,
    /// The point where it is held, in its own frame, in m.
    pub anchor: Vec3,
    /// The target position of that point, in m.
    pub target: Vec3,
}

/// The purpose of a checkpoint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// A file for the user.
    Export,
    /// A backup in case the device is lost.
    Rescue,
}

/// A command to the engine.
pub enum Command {
    /// Start this scene from its beginning.
    Open(Box<Scene>),
    /// Continue with this scene and the current fluid.
    Change(Box<Scene>),
    /// Run or pause.
    Play(bool),
    /// Simulate this long, in s, then pause.
    Advance(f32),
    /// Simulated seconds per second.
    TimeScale(f64),
    /// Apply or remove the mouse force.
    MouseForce(Option<MouseForce>),
    /// Hold or release a body.
    Grip(Option<Grip>),
    /// Whether the surface is extracted.
    Surface(bool),
    /// Whether passes are timed.
    Timing(bool),
    /// Send the current mesh of the surface.
    Export,
    /// Send a checkpoint with this text as its scene.
    Checkpoint(String, Purpose),
    /// Resume from a checkpoint.
    Resume(Box<Checkpoint>),
    /// End the engine.
    Quit,
}
