//! Finds the cut edges of every row and counts each block's vertices and triangles.
//!
//! `rows` holds two words per row: bits 0-23 of the first are the cut x-, y- and z-edges, bits 24-31 the
//! signs; the second is the number of vertices (low half) and triangles (high half) of the block's rows
//! before this one.

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
