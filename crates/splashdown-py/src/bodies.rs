//! Bodies.

use pyo3::prelude::*;
use splashdown::BodyState;

/// The position and velocity of a body, and the force of the fluid on it. Vectors are tuples in SI units.
///
/// >>> crate = {"name": "crate", "mesh": "cube", "scale": 0.1, "position": [1, 0.2, 0.25], "motion": "dynamic"}
/// >>> body = splashdown.Simulation(scene.replace(body=[crate]), device="cpu").bodies[0]
/// >>> len(body.position), len(body.orientation)
/// (3, 4)
#[pyclass(frozen, get_all, module = "splashdown")]
pub struct Body {
    /// Its name in the scene.
    name: String,
    /// Position of the mesh's origin in m.
    position: (f32, f32, f32),
    /// Unit quaternion (x, y, z, w).
    orientation: (f32, f32, f32, f32),
    /// Velocity in m/s.
    velocity: (f32, f32, f32),
    /// Angular velocity in rad/s.
    angular_velocity: (f32, f32, f32),
    /// Force of the fluid in the last step in N.
    force: (f32, f32, f32),
    /// Its torque in N m.
    torque: (f32, f32, f32),
}

impl Body {
    /// Describes a body.
    pub fn new(name: &str, state: &BodyState) -> Self {
        Self {
            name: name.to_owned(),
            position: state.position.into(),
            orientation: state.orientation.into(),
            velocity: state.velocity.into(),
            angular_velocity: state.angular_velocity.into(),
            force: state.force.into(),
            torque: state.torque.into(),
        }
    }
}

#[pymethods]
impl Body {
    fn __repr__(&self) -> String {
        format!("Body({:?}, position={:?})", self.name, self.position)
    }
}
