//! Puts the id and the number of every particle into its cell's part of `entries`, in the order of arrival.
//!
//! Each one takes itself off the cell_counts: what is left of its cell's number tells the place, and once all are placed all
//! numbers are zero again, ready for the next count. So nothing has to be cleared, and no rank to be written and read.
//!
//! The first invocation ends the step before, which would otherwise take a dispatch of its own.

mod cpu;

use glam::UVec2;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{GRID, Grid};
use crate::state::{PARAMS, Params, STATE, STEP_COUNTERS, STEPS, StepState};

bindings! {
    /// The buffers of `scatter.wgsl`.
    pub(super) struct ScatterBindings {
        params: uniform Params,
        grid: uniform Grid,
        state: write StepState,
        counters: write [u32],
        cell_counts: atomic [u32],
        cell_start: read [u32],
        ids: read [u32],
        entries: write [UVec2],
    }
}

/// See the module.
pub static SCATTER: PassDesc = PassDesc {
    label: "cells.scatter",
    wgsl: include_str!("scatter.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, GRID, STEP_COUNTERS, STEPS],
    entry: "scatter",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: ScatterBindings::LIST,
    cpu: |_, slots| cpu::scatter(slots.into()),
};
