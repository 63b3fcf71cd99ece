//! Orders the particles inside every cell by id, whatever the order of their arrival: the same state gives the same
//! bits twice.
//!
//! Every particle counts the ids of its cell that are smaller than its own; at two spacings of support a cell holds
//! about eight. Only the dead may be many: more than 1,024 of them a GPU leaves as they arrived. `order[k]` is the number, in the unsorted arrays, of the particle at place k.

mod cpu;

use glam::UVec2;
use splashdown_gpu::{PassDesc, read, wgsl, write};

use crate::passes::{STATE, StepState};

/// See the module.
pub static ORDER: PassDesc = PassDesc {
    label: "cells.order",
    wgsl: include_str!("order_cell.wgsl"),
    imports: &[wgsl::INDEX, STATE],
    entry: "order_cell",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        read::<StepState>("state"),
        read::<UVec2>("cell_rank"),
        read::<u32>("cell_start"),
        read::<u32>("slots"),
        read::<u32>("ids"),
        write::<u32>("order"),
    ],
    cpu: cpu::order,
};
