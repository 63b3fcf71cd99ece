//! [`integrate`](super::integrate) with a shifting velocity s: v += dt a, x += dt (v + s).
//!
//! The fourth component of the shifting velocity is the density, because a pass may bind at most eight storage buffers.
//! A particle whose acceleration has a fourth component other than zero is not shifted: a nozzle holds it. Walls limit v
//! and v + s, each separately.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::ADVANCE;
use crate::boundary;
use crate::cells::{CELL_COUNTS, GRID, Grid};
use crate::state::{PARAMS, Params, STATE, STEP_COUNTERS, StepState};

bindings! {
    /// The buffers of `shifted_integrate.wgsl`.
    pub(super) struct ShiftedIntegrateBindings {
        params: uniform Params,
        grid: uniform Grid,
        state: uniform StepState,
        sorted_positions: read [Vec4],
        sorted_velocities: read [Vec4],
        shifts: read [Vec4],
        accelerations: read [Vec4],
        positions: write [Vec4],
        velocities: write [Vec4],
        counters: atomic [u32],
        cell_counts: atomic [u32],
    }
}

/// See the module.
pub static SHIFTED_INTEGRATE: PassDesc = PassDesc {
    label: "shifted_integrate",
    wgsl: include_str!("shifted_integrate.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, STEP_COUNTERS, GRID, CELL_COUNTS, boundary::LAW, ADVANCE],
    entry: "shifted_integrate",
    workgroup_size: [256, 1, 1],
    constants: &[],
    bindings: ShiftedIntegrateBindings::LIST,
    cpu: |_, slots| cpu::shifted_integrate::<true>(slots.into()),
};

/// Without the count for the next step, which a pass of [`cells`](crate::cells) computes.
pub static UNCOUNTED: PassDesc = PassDesc {
    label: "shifted_integrate.uncounted",
    constants: &[("COUNTS", 0.0)],
    cpu: |_, slots| cpu::shifted_integrate::<false>(slots.into()),
    ..SHIFTED_INTEGRATE
};
