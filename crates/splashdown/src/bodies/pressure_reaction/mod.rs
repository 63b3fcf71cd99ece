//! The force of the present implicit pressure on each body: the sum of m k_i b_i over the particles near it.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::reaction;
use super::types::{self, Body, Contact};
use crate::state::{PARAMS, Params, SOLVE, STATE, SolveState, StepState};

bindings! {
    /// The buffers of `pressure_reaction.wgsl`.
    pub(super) struct PressureReactionBindings {
        params: uniform Params,
        state: uniform StepState,
        solve: uniform SolveState,
        bodies: read [Body],
        contacts: read [Contact],
        sorted_positions: read [Vec4],
        predicted: read [Vec4],
        sums: atomic [u32],
    }
}

/// See the module.
pub static PRESSURE_REACTION: PassDesc = PassDesc {
    label: "bodies.pressure_reaction",
    wgsl: include_str!("pressure_reaction.wgsl"),
    imports: &[wgsl::INDEX, STATE, SOLVE, PARAMS, types::WGSL, reaction::WGSL],
    entry: "pressure_reaction",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: PressureReactionBindings::LIST,
    cpu: |_, slots| cpu::pressure_reaction(slots.into()),
};
