//! Writes the id and the index of every particle into the part of `entries` that belongs to its cell, in the order of
//! arrival.
//!
//! Each particle decrements the count of its cell, and the remaining count determines its place. Afterwards all counts
//! are zero again for the next count, so that no clear and no array of ranks is needed.
//!
//! The first invocation ends the previous step, which saves a dispatch.

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
