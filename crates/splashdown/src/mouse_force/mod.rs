//! A hand in the water: whoever watches a simulation can stir it.
//!
//! The hand is a soft rod along a line, usually the line of sight through the mouse, that carries fluid along
//! with it. What it does is no physics of water; a run from the command line has no hand.

pub mod apply;

use glam::Vec3;
use splashdown_gpu::{Buffer, BufferSet, Executor, GpuError, PassDesc, WgslModule, buffer_set, gpu_struct};

use crate::coupling::{Coupling, Stage, StepRecorder};

/// The WGSL side of [`MouseForce`].
pub(crate) const MOUSE_FORCE: WgslModule =
    WgslModule { name: "sph/mouse_force", source: include_str!("mouse_force.wgsl") };

gpu_struct! {
    /// A rod that carries fluid along: a = rate w (velocity - v) across it, w = (1 - (d / radius)^2)^2 at a
    /// distance d from its axis.
    pub struct MouseForce {
        /// A point on the rod's axis in m.
        origin: Vec3,
        /// Where the rod ends, in m from its axis.
        radius: f32,
        /// The axis, a unit vector.
        direction: Vec3,
        /// How quickly fluid takes the hand's velocity, in 1/s; 0 for no hand.
        rate: f32,
        /// The hand's velocity in m/s; its part along the axis does nothing.
        velocity: Vec3,
        /// Nothing.
        unused: f32,
    }
}

impl MouseForce {
    /// None.
    pub(crate) const NONE: Self = Self {
        origin: Vec3::ZERO,
        radius: 1.0,
        direction: Vec3::NEG_Y,
        rate: 0.0,
        velocity: Vec3::ZERO,
        unused: 0.0,
    };

    /// A hand that moves with `velocity` (m/s) along the line through `origin` (m) in this direction.
    pub fn new(origin: Vec3, direction: Vec3, velocity: Vec3, radius: f32, rate: f32) -> Self {
        Self { origin, radius, direction: direction.normalize_or(Vec3::NEG_Y), rate, velocity, unused: 0.0 }
    }

    /// What it does to fluid at `x` with velocity `v`, in m/s^2.
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

/// The hand's place on a device.
pub struct MouseForceCoupling {
    mouse_force: Buffer<MouseForce>,
}

impl MouseForceCoupling {
    /// Makes the place, with no hand in it.
    ///
    /// # Errors
    /// As [`Executor::create`].
    pub fn new(executor: &mut Executor) -> Result<Self, GpuError> {
        Ok(Self { mouse_force: executor.create("mouse_force", 1)? })
    }

    /// Puts a hand there.
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
