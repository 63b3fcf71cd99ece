//! The results of the iterations, scaled so that the residual does no work: the whole acceleration, that by the pressure
//! (in `predicted`), the pressure, the pressure with which the next step starts, and the pressure that limits its length.
//!
//! If the step was shortened after the solution ([`decide`](super::decide)), the impulse of the pressure is that of the whole
//! length, so that the pressure of this step is larger; the next one starts with the pressure of the solution. A nozzle
//! determines the velocity of its particles, whatever the length.
//!
//! The limit keeps displacements across the neighbours from growing over several steps, so it follows from a mean over the
//! steps: max(r, 1 - r) of the new pressure and the rest of the old mean, where r is the part of the new pressure in the mean
//! with which the next step starts. In violent flows r is about a half, and the mean follows a lasting pressure within two
//! steps. An impact transfers its momentum in one step, with a pressure in inverse proportion to the step; if this pressure
//! limited the next step alone, repeated impacts would shorten the steps to a quarter of a spacing per |v|max. In calm flows,
//! where the mean is slow, the new pressure counts almost alone.

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::cells::{GRID, Grid, ROWS};
use crate::state::{PARAMS, Params, SOLVE, STATE, STEP_COUNTERS, SolveState, StepState};

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
        counters: atomic [u32],
    }
}

/// See the module.
pub static FINISH: PassDesc = PassDesc {
    label: "implicit.finish",
    wgsl: include_str!("implicit_finish.wgsl"),
    imports: &[wgsl::INDEX, STATE, SOLVE, PARAMS, GRID, ROWS, STEP_COUNTERS],
    entry: "implicit_finish",
    workgroup_size: [256, 1, 1],
    constants: &[],
    bindings: FinishBindings::LIST,
    cpu: |_, slots| cpu::finish(slots.into()),
};
