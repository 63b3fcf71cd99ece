//! Moves the bodies by a step: dynamic bodies by the force of the fluid and gravity, scripted bodies by their scripts.
//!
//! Rigid body motion by symplectic Euler: v += dt (F/M + g). The rotation keeps the angular momentum L, which a torque
//! changes by dt times the torque: the orientation q changes by the exponential of the rotation vector omega dt, with
//! omega = I^-1 L at the middle of the step, and afterwards omega = I^-1 L for the new orientation. An explicit
//! gyroscopic term, omega x I omega, would add energy to a body that tumbles fast.
//!
//! The motor of a hinge changes L towards that of its speed, with at most its torque.
//!
//! A scripted body follows a cubic between the samples that the host has written for the frame.

mod cpu;

pub(super) use cpu::next_velocities;

use splashdown_gpu::{PassDesc, WgslModule, bindings};

use super::types::{self, Body, ScriptSample, Support};
use crate::state::{PARAMS, Params, STATE, STEP_COUNTERS, StepState};

/// Sums, matrices and velocities of bodies.
pub(super) const ALGEBRA: WgslModule =
    WgslModule { name: "sph/body_algebra", source: include_str!("../body_algebra.wgsl") };
/// The velocities of a dynamic body after a step; imports [`ALGEBRA`].
pub(super) const VELOCITIES: WgslModule =
    WgslModule { name: "sph/body_velocities", source: include_str!("../body_velocities.wgsl") };

bindings! {
    /// The buffers of `motion.wgsl`.
    pub(super) struct MotionBindings {
        params: uniform Params,
        state: read StepState,
        scripts: read [ScriptSample],
        supports: read [Support],
        bodies: write [Body],
        sums: write [u32],
        counters: atomic [u32],
    }
}

/// See the module.
pub static MOTION: PassDesc = PassDesc {
    label: "bodies.motion",
    wgsl: include_str!("motion.wgsl"),
    imports: &[STATE, PARAMS, STEP_COUNTERS, types::WGSL, ALGEBRA, VELOCITIES],
    entry: "motion",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: MotionBindings::LIST,
    cpu: |_, slots| cpu::motion(slots.into()),
};
