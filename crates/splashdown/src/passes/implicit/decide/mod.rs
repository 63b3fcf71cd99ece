//! Ends an iteration: the mean residual, whether to stop, and the factor of the next direction (see the [module](super)).
//!
//! # Impacts
//! A layer of water that falls flat on a floor loses its velocity in one step. The system is linear, so this step closes the
//! whole gap to the floor, and leaves excesses of density of up to 40 %, because the density is not linear in the
//! displacement. Where the accepted pressure displaces the particles by more than 0.05 spacings (root mean square over the
//! fluid), the step is therefore shortened after the solution: the velocities receive the whole impulse of the pressure, and
//! the positions advance for a shorter time, at least a tenth of the step. What remains of the gap closes in the next steps, at
//! the lower velocity. Few other steps are shortened: where the pressure carries the weight of the water, it displaces by at
//! most 0.02 spacings, because gravity limits the step. With an implicit viscosity, whose steps are longer, none is.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings};

use crate::cells::{GRID, Grid, ROWS};
use crate::state::{PARAMS, Params, SOLVE, STATE, STEP_COUNTERS, SolveState, StepState};

/// The largest displacement by the pressure in a step, in spacings: the root mean square over the fluid.
const LARGEST_STOP: f32 = 0.05;
/// The shortest step over the length that the pressure was solved for.
const LEAST_PART: f32 = 0.1;

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
