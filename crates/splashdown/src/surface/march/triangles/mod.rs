//! The triangles of every cell, as vertex indices.
//!
//! A triangle with a vertex beyond the capacity gets three equal indices: it is not drawn, and no
//! access is out of range.

mod cpu;

use glam::UVec2;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::surface::modules::{LATTICE, SIGNS, SLOTS, STATUS};
use crate::surface::params::{Lattice, Status};

bindings! {
    /// The buffers of `triangles.wgsl`.
    pub(super) struct TrianglesBindings {
        lattice: uniform Lattice,
        status: read Status,
        block_list: read [u32],
        block_slot: read [u32],
        rows: read [UVec2],
        cases: read [UVec2],
        vertex_starts: read [u32],
        triangle_starts: read [u32],
        indices: write [u32],
    }
}

pub(crate) static TRIANGLES: PassDesc = PassDesc {
    label: "surface.triangles",
    wgsl: include_str!("triangles.wgsl"),
    imports: &[wgsl::INDEX, STATUS, LATTICE, SLOTS, SIGNS],
    entry: "triangles",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: TrianglesBindings::LIST,
    cpu: |_, slots| cpu::triangles(slots.into()),
};
