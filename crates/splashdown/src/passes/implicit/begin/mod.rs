//! Begins the iterations of a step; after the end of a frame there are none.
//!
//! Computes what the iterations need of each particle: the pressure with which they start, the excess of density of the
//! present positions, and the velocity by all forces but the pressure.

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::cells::{GRID, Grid, ROWS};
use crate::state::{PARAMS, Params, SOLVE, STATE, SolveState, StepState};

bindings! {
    /// The buffers of `implicit_begin.wgsl`.
    pub(super) struct BeginBindings {
        params: uniform Params,
        grid: uniform Grid,
        state: uniform StepState,
        cell_start: read [u32],
        sorted_velocities: read [Vec4],
        sorted_pressures: read [f32],
        accelerations: read [Vec4],
        densities: read [Vec2],
        solve: write SolveState,
        iterates: write [Vec4],
        free_velocities: write [Vec4],
    }
}

/// See the module.
pub static BEGIN: PassDesc = PassDesc {
    label: "implicit.begin",
    wgsl: include_str!("implicit_begin.wgsl"),
    imports: &[wgsl::INDEX, STATE, SOLVE, PARAMS, GRID, ROWS],
    entry: "implicit_begin",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: BeginBindings::LIST,
    cpu: |_, slots| cpu::begin(slots.into()),
};
