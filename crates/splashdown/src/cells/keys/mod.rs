//! Writes (cell, index) pairs for the bitonic sort, the baseline from the thesis.

mod cpu;

use glam::UVec2;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{GRID, Grid};
use crate::state::{STATE, StepState};

bindings! {
    /// The buffers of `keys.wgsl`.
    pub(super) struct KeysBindings {
        grid: uniform Grid,
        state: read StepState,
        cell_counts: read [u32],
        pairs: write [UVec2],
    }
}

/// See the module.
pub static KEYS: PassDesc = PassDesc {
    label: "cells.keys",
    wgsl: include_str!("keys.wgsl"),
    imports: &[wgsl::INDEX, STATE, GRID],
    entry: "keys",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: KeysBindings::LIST,
    cpu: |_, slots| cpu::keys(slots.into()),
};
