//! The results of the iterations, scaled so that the residual does no work: the whole acceleration, that by the pressure
//! (in `predicted`), the pressure, and the pressure with which the next step starts.

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::cells::{GRID, Grid, ROWS};
use crate::state::{PARAMS, Params, SOLVE, STATE, SolveState, StepState};

bindings! {
    /// The buffers of `implicit_finish.wgsl`.
    pub(super) struct FinishBindings {
        params: uniform Params,
        grid: uniform Grid,
        state: uniform StepState,
        solve: uniform SolveState,
        cell_start: read [u32],
        sorted_velocities: read [Vec4],
        sorted_pressures: read [f32],
        predicted: write [Vec4],
        accelerations: write [Vec4],
        densities: write [Vec2],
        pressures: write [f32],
    }
}

/// See the module.
pub static FINISH: PassDesc = PassDesc {
    label: "implicit.finish",
    wgsl: include_str!("implicit_finish.wgsl"),
    imports: &[wgsl::INDEX, STATE, SOLVE, PARAMS, GRID, ROWS],
    entry: "implicit_finish",
    workgroup_size: [256, 1, 1],
    constants: &[],
    bindings: FinishBindings::LIST,
    cpu: |_, slots| cpu::finish(slots.into()),
};
