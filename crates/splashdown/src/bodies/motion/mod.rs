//! Moves the bodies by a step: dynamic bodies by the force of the fluid and gravity, scripted bodies by their scripts.
//!
//! Rigid body motion by symplectic Euler: v += dt (F/M + g); omega += dt I^-1 (torque - omega x I omega). The
//! orientation changes by the exponential of the rotation vector omega dt, so that it remains a unit quaternion. A
//! scripted body follows a cubic between the samples that the host has written for the frame.

mod cpu;

pub(super) use cpu::next_velocities;

use splashdown_gpu::{PassDesc, WgslModule, bindings};

use super::types::{self, Body, ScriptSample};
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
