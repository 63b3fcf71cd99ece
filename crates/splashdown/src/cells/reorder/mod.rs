//! Copies the particles into the order of their cells, and inside every cell into that of their ids, whatever
//! the order of their arrival: the same state gives the same bits twice.
//!
//! Every particle counts the ids of its cell that are smaller than its own; at two spacings of support a cell holds
//! about eight. Only the dead may be many: more than 1,024 of them a GPU leaves as they arrived.
//!
//! The ids are read from `entries`, so that the sorted ones may go straight to the persistent array: a step
//! integrates back in this order. A sort without a step leaves the persistent arrays alone and has `sorted_ids`
//! for them.

mod cpu;

use glam::{UVec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{GRID, Grid};

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
    imports: &[wgsl::INDEX, GRID],
    entry: "reorder",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: ReorderBindings::LIST,
    cpu: |_, slots| cpu::reorder(slots.into()),
};
