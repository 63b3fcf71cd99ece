//! Ends an iteration: the residual, whether to stop, and the lengths of the next change (see the [module](super)).

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings};

use crate::cells::{GRID, Grid, ROWS};
use crate::state::{PARAMS, Params, STATE, STEP_COUNTERS, StepState, VISCOUS, ViscousState};

bindings! {
    /// The buffers of `viscous_decide.wgsl`.
    pub(super) struct DecideBindings {
        params: uniform Params,
        grid: uniform Grid,
        cell_start: read [u32],
        residuals: read [Vec4],
        impulses: read [Vec4],
        state: write StepState,
        viscous: write ViscousState,
        counters: write [u32],
    }
}

/// See the module.
pub static DECIDE: PassDesc = PassDesc {
    label: "viscous.decide",
    wgsl: include_str!("viscous_decide.wgsl"),
    imports: &[STATE, VISCOUS, PARAMS, GRID, ROWS, STEP_COUNTERS],
    entry: "viscous_decide",
    workgroup_size: [256, 1, 1],
    constants: &[],
    bindings: DecideBindings::LIST,
    cpu: |_, slots| cpu::decide(slots.into()),
};
