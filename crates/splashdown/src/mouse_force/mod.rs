//! The mouse force, with which a user of the window stirs the fluid.
//!
//! It acts like a soft rod that drags fluid along. The axis of the rod is usually the line of sight through the mouse
//! pointer. It is not a physical model, and runs from the command line do not use it.

pub mod apply;

use glam::Vec3;
use splashdown_gpu::{Buffer, BufferSet, Executor, GpuError, PassDesc, WgslModule, buffer_set, gpu_struct};

use crate::coupling::{Coupling, Stage, StepRecorder};

/// The WGSL side of [`MouseForce`].
pub(crate) const MOUSE_FORCE: WgslModule =
    WgslModule { name: "sph/mouse_force", source: include_str!("mouse_force.wgsl") };

gpu_struct! {
    /// A rod that drags fluid along. The acceleration across its axis is a = rate w (velocity - v), with
    /// w = (1 - (d / radius)^2)^2 at a distance d from the axis.
    pub struct MouseForce {
        /// A point on the rod's axis in m.
        origin: Vec3,
        /// Radius of the rod in m.
        radius: f32,
        /// Direction of the axis, a unit vector.
        direction: Vec3,
        /// Rate in 1/s at which the fluid assumes the velocity of the rod; 0 for no force.
        rate: f32,
        /// Velocity of the rod in m/s. The component along the axis has no effect.
        velocity: Vec3,
        /// Padding.
        unused: f32,
    }
}

impl MouseForce {
    /// No force.
    pub(crate) const NONE: Self = Self {
        origin: Vec3::ZERO,
        radius: 1.0,
        direction: Vec3::NEG_Y,
        rate: 0.0,
        velocity: Vec3::ZERO,
        unused: 0.0,
    };

    /// A rod with this velocity (m/s), whose axis goes through `origin` (m) in this direction.
    pub fn new(origin: Vec3, direction: Vec3, velocity: Vec3, radius: f32, rate: f32) -> Self {
        Self { origin, radius, direction: direction.normalize_or(Vec3::NEG_Y), rate, velocity, unused: 0.0 }
    }

    /// The acceleration in m/s^2 of fluid at `x` (m) with velocity `v` (m/s).
    pub fn acceleration(&self, x: Vec3, v: Vec3) -> Vec3 {
        let across = |u: Vec3| u - self.direction * self.direction.dot(u);
        let distance = across(x - self.origin);
        let inside = 1.0 - distance.dot(distance) / (self.radius * self.radius);
        if inside <= 0.0 {
            return Vec3::ZERO;
        }
        self.rate * inside * inside * across(self.velocity - v)
    }
}

/// The passes of this module.
pub fn passes() -> Vec<&'static PassDesc> {
    vec![&apply::APPLY]
}

/// The mouse force on a device.
pub struct MouseForceCoupling {
    mouse_force: Buffer<MouseForce>,
}

impl MouseForceCoupling {
    /// Creates the buffer, without a force.
    ///
    /// # Errors
    /// As [`Executor::create`].
    pub fn new(executor: &mut Executor) -> Result<Self, GpuError> {
        Ok(Self { mouse_force: executor.create("mouse_force", 1)? })
    }

    /// Sets the force.
    ///
    /// # Errors
    /// If the device was lost.
    pub fn set(&self, executor: &mut Executor, mouse_force: MouseForce) -> Result<(), GpuError> {
        executor.write(self.mouse_force, &[mouse_force])
    }
}

impl Coupling for MouseForceCoupling {
    fn stages(&self) -> &'static [Stage] {
        &[Stage::ExternalForces]
    }

    fn buffers(&self) -> BufferSet {
        buffer_set!(self => mouse_force)
    }

    fn record(&self, _: Stage, step: &mut StepRecorder<'_>) {
        step.dispatch_particles(&apply::APPLY);
    }
}
