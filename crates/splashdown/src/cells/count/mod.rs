//! Counts the particles of every cell and stores the cell of each particle, before the first step of a frame and after
//! emission. In all other steps the integration counts.
//!
//! Removed particles are counted in one more cell behind the last, so that the sort places them behind the active ones.
//! Particles that are outside the domain, or whose position, velocity or density is not finite, are marked as removed
//! and counted here, before they affect neighbours.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{CELL_COUNTS, GRID, Grid};
use crate::state::{PARAMS, Params, STATE, STEP_COUNTERS, StepState};

bindings! {
    /// The buffers of `count.wgsl`.
    pub(super) struct CountBindings {
        params: uniform Params,
        grid: uniform Grid,
        state: read StepState,
        positions: write [Vec4],
        velocities: read [Vec4],
        cell_counts: atomic [u32],
        counters: atomic [u32],
    }
}

/// See the module.
pub static COUNT: PassDesc = PassDesc {
    label: "cells.count",
    wgsl: include_str!("count.wgsl"),
    imports: &[wgsl::INDEX, GRID, STATE, PARAMS, STEP_COUNTERS, CELL_COUNTS],
    entry: "count",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: CountBindings::LIST,
    cpu: |_, slots| cpu::count(slots.into()),
};
