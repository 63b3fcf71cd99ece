//! The velocities that dynamic bodies get by the present implicit pressure and all other forces, as far as their
//! [supports](super::support) allow: two vectors per body.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings};

use super::types::{self, Body, Support};
use super::{motion, support};
use crate::state::{PARAMS, Params, SOLVE, STATE, SolveState, StepState};

bindings! {
    /// The buffers of `pressure_response.wgsl`.
    pub(super) struct PressureResponseBindings {
        params: uniform Params,
        state: uniform StepState,
        solve: uniform SolveState,
        bodies: read [Body],
        sums: read [u32],
        pressure_sums: write [u32],
        responses: write [Vec4],
        supports: write [Support],
    }
}

/// See the module.
pub static PRESSURE_RESPONSE: PassDesc = PassDesc {
    label: "bodies.pressure_response",
    wgsl: include_str!("pressure_response.wgsl"),
    imports: &[STATE, SOLVE, PARAMS, types::WGSL, motion::ALGEBRA, motion::VELOCITIES, support::WGSL],
    entry: "pressure_response",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: PressureResponseBindings::LIST,
    cpu: |_, slots| cpu::pressure_response(slots.into()),
};
