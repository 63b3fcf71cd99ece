//! After the bitonic sort: extracts the indices of the particles from the pairs, and finds the begin of every cell (the
//! grid indices of the thesis).

mod cpu;

use glam::UVec2;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{GRID, Grid};
use crate::state::{STATE, StepState};

bindings! {
    /// The buffers of `bounds.wgsl`.
    pub(super) struct BoundsBindings {
        grid: uniform Grid,
        state: read StepState,
        pairs: read [UVec2],
        ids: read [u32],
        cell_start: write [u32],
        entries: write [UVec2],
    }
}

/// See the module.
pub static BOUNDS: PassDesc = PassDesc {
    label: "cells.bounds",
    wgsl: include_str!("bounds.wgsl"),
    imports: &[wgsl::INDEX, GRID, STATE],
    entry: "bounds",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: BoundsBindings::LIST,
    cpu: |_, slots| cpu::bounds(slots.into()),
};
