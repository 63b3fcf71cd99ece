//! Finds the cut edges of every row and counts the vertices and triangles of each block.
//!
//! `rows` has two words per row. Bits 0-23 of the first are the cut x-, y- and z-edges, bits 24-31
//! the signs. The second is the number of vertices (low half) and triangles (high half) of the
//! preceding rows of the block.

mod cpu;

use glam::UVec2;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::surface::modules::{LATTICE, SIGNS, SLOTS, STATUS};
use crate::surface::params::{Lattice, Status};

bindings! {
    /// The buffers of `count.wgsl`.
    pub(super) struct CountBindings {
        lattice: uniform Lattice,
        status: read Status,
        block_list: read [u32],
        block_slot: read [u32],
        signs: read [u32],
        cases: read [UVec2],
        rows: write [UVec2],
        vertex_counts: write [u32],
        triangle_counts: write [u32],
    }
}

pub(crate) static COUNT: PassDesc = PassDesc {
    label: "surface.count",
    wgsl: include_str!("count.wgsl"),
    imports: &[wgsl::INDEX, STATUS, LATTICE, SLOTS, SIGNS],
    entry: "count",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: CountBindings::LIST,
    cpu: |_, slots| cpu::count(slots.into()),
};
