//! Ends an iteration: the mean residual, whether to stop, the factor of the next direction (see the [module](super)), and
//! after an impact the length of the step.
//!
//! # Impacts
//! A layer of water that falls flat on a floor loses its velocity in one step. The system is linear, so this step closes the
//! whole gap to the floor, and leaves excesses of density of up to 40 %, because the density is not linear in the
//! displacement. Where the pressure displaces the particles by more than 0.1 spacings (root mean square over the fluid), the
//! step is therefore shortened after the solution, until this is 0.05 spacings, or to a tenth. The velocities receive the
//! whole impulse of the pressure, and the positions advance for the shorter time. What remains of the gap closes in the next
//! steps, at the lower velocity. All other forces act for the shorter time only, although the pressure balances them for the
//! whole length. The next step corrects this.
//!
//! A step is shortened to half of its length or less. The rest of a frame is then never much shorter than a step: every step
//! removes a fixed part of an excess of density, which would be an explosion in a very short one. The pressure of water at rest
//! displaces by at most 0.02 spacings, because gravity limits the step. Steps that did not converge are not shortened, because
//! the next one is shorter anyway, and neither are those with an implicit viscosity, which are longer.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings};

use crate::cells::{GRID, Grid, ROWS};
use crate::state::{PARAMS, Params, SOLVE, STATE, STEP_COUNTERS, SolveState, StepState};

/// The largest displacement by the pressure in a step that is not shortened, in spacings: the root mean square over the fluid.
const LARGEST_DISPLACEMENT: f32 = 0.1;
/// The displacement to which a step is shortened. At most half of the former (see the module).
const SHORTENED_DISPLACEMENT: f32 = 0.05;
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
