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
use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use super::{GRID, Grid};

/// See the module.
pub static REORDER: PassDesc = PassDesc {
    label: "cells.reorder",
    wgsl: include_str!("reorder.wgsl"),
    imports: &[wgsl::INDEX, GRID],
    entry: "reorder",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Grid>("grid"),
        read::<u32>("cell_counts"),
        read::<u32>("cell_start"),
        read::<UVec2>("entries"),
        read::<Vec4>("positions"),
        read::<Vec4>("velocities"),
        write::<Vec4>("sorted_positions"),
        write::<Vec4>("sorted_velocities"),
        write::<u32>("sorted_ids"),
    ],
    cpu: cpu::reorder,
};
