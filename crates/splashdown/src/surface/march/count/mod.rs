//! Finds the cut edges of every row and counts the vertices and triangles of each block.
//!
//! `rows` has two words per row. Bits 0-23 of the first are the cut x-, y- and z-edges, bits 24-31
//! the signs. The second is the number of vertices (low half) and triangles (high half) of the
//! preceding rows of the block.

mod cpu;

use glam::UVec2;
use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use crate::surface::modules::{LATTICE, SIGNS, SLOTS, STATUS};
use crate::surface::params::{Lattice, Status};

pub(crate) static COUNT: PassDesc = PassDesc {
    label: "surface.count",
    wgsl: include_str!("count.wgsl"),
    imports: &[wgsl::INDEX, STATUS, LATTICE, SLOTS, SIGNS],
    entry: "count",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Lattice>("lattice"),
        read::<Status>("status"),
        read::<u32>("block_list"),
        read::<u32>("block_slot"),
        read::<u32>("signs"),
        read::<UVec2>("cases"),
        write::<UVec2>("rows"),
        write::<u32>("vertex_counts"),
        write::<u32>("triangle_counts"),
    ],
    cpu: cpu::count,
};
