//! Ends an iteration: the mean residual, whether to stop, and the factor of the next direction (see the [module](super)).

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings};

use crate::cells::{GRID, Grid, ROWS};
use crate::state::{PARAMS, Params, SOLVE, STATE, STEP_COUNTERS, SolveState, StepState};

bindings! {
    /// The buffers of `implicit_decide.wgsl`.
    pub(super) struct DecideBindings {
        params: uniform Params,
        grid: uniform Grid,
        cell_start: read [u32],
        residuals: read [Vec4],
        impulses: read [Vec4],
        state: write StepState,
        solve: write SolveState,
        counters: write [u32],
    }
}

/// See the module.
pub static DECIDE: PassDesc = PassDesc {
    label: "implicit.decide",
    wgsl: include_str!("implicit_decide.wgsl"),
    imports: &[STATE, SOLVE, PARAMS, GRID, ROWS, STEP_COUNTERS],
    entry: "implicit_decide",
    workgroup_size: [256, 1, 1],
    constants: &[],
    bindings: DecideBindings::LIST,
    cpu: |_, slots| cpu::decide(slots.into()),
};
