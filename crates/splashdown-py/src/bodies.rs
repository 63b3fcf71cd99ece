//! Bodies.

use pyo3::prelude::*;
use splashdown::BodyState;
use splashdown::glam::Quat;

/// The position and velocity of a body, and the force of the fluid on it. Vectors are tuples in SI units.
///
/// >>> stats = simulation.advance(0.01)
/// >>> body = simulation.bodies[0]
/// >>> body.velocity[1] < 0  # the crate falls
/// True
#[pyclass(frozen, get_all, module = "splashdown")]
pub struct Body {
    /// Its name in the scene.
    ///
    /// >>> frame.bodies[0].name
    /// 'crate'
    pub name: String,
    /// Position of the mesh's origin in m.
    ///
    /// >>> [round(x, 3) for x in frame.bodies[0].position]  # m
    /// [1.0, 0.5, 0.25]
    position: (f32, f32, f32),
    /// Unit quaternion (x, y, z, w).
    ///
    /// >>> frame.bodies[0].orientation
    /// (0.0, 0.0, 0.0, 1.0)
    orientation: (f32, f32, f32, f32),
    /// Velocity in m/s.
    ///
    /// >>> frame.bodies[0].velocity  # m/s
    /// (0.0, 0.0, 0.0)
    velocity: (f32, f32, f32),
    /// Angular velocity in rad/s.
    ///
    /// >>> frame.bodies[0].angular_velocity  # rad/s
    /// (0.0, 0.0, 0.0)
    angular_velocity: (f32, f32, f32),
    /// Force of the fluid in the last step in N.
    ///
    /// >>> frame.bodies[0].force  # N; the crate is in the air
    /// (0.0, 0.0, 0.0)
    force: (f32, f32, f32),
    /// Its torque in N m.
    ///
    /// >>> frame.bodies[0].torque  # N m
    /// (0.0, 0.0, 0.0)
    torque: (f32, f32, f32),
}

impl Body {
    /// Its place.
    pub fn state(&self) -> BodyState {
        let [x, y, z, w] = self.orientation.into();
        BodyState::at(<[f32; 3]>::from(self.position).into(), Quat::from_xyzw(x, y, z, w))
    }

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
