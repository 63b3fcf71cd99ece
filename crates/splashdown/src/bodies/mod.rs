//! Bodies that the fluid meets.

use std::sync::Arc;

use glam::{Quat, Vec3};
use splashdown_io::Mesh;

/// A body's shape.
#[derive(Clone, Debug)]
pub struct BodyMesh {
    /// The body's name in the scene.
    pub name: String,
    /// Its repaired triangles in m, in the mesh's own frame: rotate and move them by [`BodyState`].
    pub mesh: Arc<Mesh>,
    /// Linear RGB in [0, 1], if the scene gives one.
    pub colour: Option<[f32; 3]>,
}

/// Where a body is, and what the fluid does to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// Where the mesh's origin is, in m.
    pub position: Vec3,
    /// The mesh's rotation.
    pub orientation: Quat,
    /// Velocity of the mesh's origin in m/s.
    pub velocity: Vec3,
    /// Angular velocity in rad/s.
    pub angular_velocity: Vec3,
    /// Force of the fluid in the last step, in N.
    pub force: Vec3,
    /// Its torque about the centre of mass (dynamic bodies) or the mesh's origin, in N m.
    pub torque: Vec3,
}
