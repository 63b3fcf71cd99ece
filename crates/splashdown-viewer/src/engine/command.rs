//! What the window asks for.

use glam::Vec3;
use splashdown::scene::Scene;
use splashdown::{Checkpoint, MouseForce};

/// Which device simulates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Simulate {
    /// The one that draws.
    WhereDrawn,
    /// The CPU: where the device that draws is a software driver, it is many times faster.
    OnCpu,
}

/// A free body held at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grip {
    /// Number of the body, in the order of the scene.
    pub body: usize,
    /// The point where it is held, in its own frame, in m.
    pub anchor: Vec3,
    /// Where that point shall be, in m.
    pub target: Vec3,
}

/// What a checkpoint is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// The user wants it as a file.
    Keep,
    /// It is there in case the device is lost.
    Rescue,
}

/// What the window asks for.
pub enum Command {
    /// Start this scene from its beginning.
    Open(Box<Scene>),
    /// Go on under this scene, with the fluid as it is.
    Change(Box<Scene>),
    /// Run, or stand still.
    Play(bool),
    /// Simulate this long, in s, and stand still.
    Advance(f32),
    /// Simulated seconds per second.
    TimeScale(f64),
    /// Put a hand into the water, or take it out.
    Hand(Option<MouseForce>),
    /// Hold a body, or let go.
    Grip(Option<Grip>),
    /// Whether the surface is wanted.
    Surface(bool),
    /// Whether passes are timed.
    Timing(bool),
    /// Hand out the surface's mesh as it is.
    Export,
    /// Hand out a checkpoint with this text as its scene.
    Checkpoint(String, Purpose),
    /// Go on from a checkpoint.
    Resume(Box<Checkpoint>),
    /// Stop for good.
    Quit,
}
