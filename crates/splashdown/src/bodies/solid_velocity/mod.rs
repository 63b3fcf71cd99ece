//! The product of the solid gradient at a particle with the velocity that the bodies get by the present implicit pressure.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::types::{self, Body, Contact};
use crate::state::{SOLVE, STATE, SolveState, StepState};

bindings! {
    /// The buffers of `solid_velocity.wgsl`.
    pub(super) struct SolidVelocityBindings {
        state: uniform StepState,
        solve: uniform SolveState,
        bodies: read [Body],
        contacts: read [Contact],
        sorted_positions: read [Vec4],
        responses: read [Vec4],
        solid_gradients: write [Vec4],
    }
}

/// See the module.
pub static SOLID_VELOCITY: PassDesc = PassDesc {
    label: "bodies.solid_velocity",
    wgsl: include_str!("solid_velocity.wgsl"),
    imports: &[wgsl::INDEX, STATE, SOLVE, types::WGSL],
    entry: "solid_velocity",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: SolidVelocityBindings::LIST,
    cpu: |_, slots| cpu::solid_velocity(slots.into()),
};
