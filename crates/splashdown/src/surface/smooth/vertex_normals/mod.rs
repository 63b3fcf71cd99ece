//! Vertex normals of the smoothed mesh: the normals of the adjacent triangles, weighted by area.
//! A vertex on a wall has the normal of the wall, and triangles in walls do not contribute to the
//! normals of the free surface.

mod cpu;

use glam::{UVec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::surface::modules::{LATTICE, STATUS, WALLS};
use crate::surface::params::{Lattice, Status};

bindings! {
    /// The buffers of `vertex_normals.wgsl`.
    pub(super) struct VertexNormalsBindings {
        lattice: uniform Lattice,
        status: read Status,
        one_ring_starts: read [u32],
        one_rings: read [UVec2],
        vertex_positions: read [Vec4],
        normals: write [Vec4],
    }
}

pub(crate) static VERTEX_NORMALS: PassDesc = PassDesc {
    label: "surface.vertex_normals",
    wgsl: include_str!("vertex_normals.wgsl"),
    imports: &[wgsl::INDEX, STATUS, LATTICE, WALLS],
    entry: "vertex_normals",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: VertexNormalsBindings::LIST,
    cpu: |_, slots| cpu::vertex_normals(slots.into()),
};
