//! One vertex per cut edge, with a normal from the gradient of the field.
//!
//! The position on the edge is `t = (iso - a) / (b - a)` for the values a and b at its ends,
//! clamped to [0.001, 0.999]: at an end, the vertices of several edges would coincide and form
//! triangles without area. If the edge crosses a wall before, the vertex lies exactly on the wall and
//! has its normal. Otherwise the normal is the negative gradient by central differences at both ends,
//! interpolated by t.

mod cpu;

use glam::{UVec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::surface::modules::{LATTICE, SLOTS, STATUS, WALLS};
use crate::surface::params::{Lattice, Status};

bindings! {
    /// The buffers of `vertices.wgsl`.
    pub(super) struct VerticesBindings {
        lattice: uniform Lattice,
        status: read Status,
        block_list: read [u32],
        block_slot: read [u32],
        field_values: read [f32],
        rows: read [UVec2],
        vertex_starts: read [u32],
        vertex_positions: write [Vec4],
        normals: write [Vec4],
    }
}

pub(crate) static VERTICES: PassDesc = PassDesc {
    label: "surface.vertices",
    wgsl: include_str!("vertices.wgsl"),
    imports: &[wgsl::INDEX, STATUS, LATTICE, SLOTS, WALLS],
    entry: "vertices",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: VerticesBindings::LIST,
    cpu: |_, slots| cpu::vertices(slots.into()),
};
