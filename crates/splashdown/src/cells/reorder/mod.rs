//! Copies the particles into the order of their cells, and within a cell into the order of their ids. The result does
//! not depend on the order of arrival, so that equal states give bit-identical results.
//!
//! Every particle counts the ids of its cell that are smaller than its own; with a support of two spacings a cell holds
//! about eight particles. Only the removed particles may be many: a GPU does not sort more than 1,024 of them.
//!
//! The ids are read from `entries`, so that the sorted ids may be written to the persistent array: a step integrates
//! back in this order. A sort without a step does not change the persistent arrays, and writes to `sorted_ids`.

mod cpu;

use glam::{UVec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{GRID, Grid, PLACE};

bindings! {
    /// The buffers of `reorder.wgsl`.
    pub(super) struct ReorderBindings {
        grid: uniform Grid,
        cell_counts: read [u32],
        cell_start: read [u32],
        entries: read [UVec2],
        positions: read [Vec4],
        velocities: read [Vec4],
        sorted_positions: write [Vec4],
        sorted_velocities: write [Vec4],
        sorted_ids: write [u32],
    }
}

/// See the module.
pub static REORDER: PassDesc = PassDesc {
    label: "cells.reorder",
    wgsl: include_str!("reorder.wgsl"),
    imports: &[wgsl::INDEX, GRID, PLACE],
    entry: "reorder",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: ReorderBindings::LIST,
    cpu: |_, slots| cpu::reorder(slots.into()),
};
