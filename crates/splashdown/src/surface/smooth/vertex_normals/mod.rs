//! Vertex normals of the smoothed mesh: the normals of the adjacent triangles, weighted by area.

mod cpu;

use glam::{UVec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::surface::modules::STATUS;
use crate::surface::params::Status;

bindings! {
    /// The buffers of `vertex_normals.wgsl`.
    pub(super) struct VertexNormalsBindings {
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
    imports: &[wgsl::INDEX, STATUS],
    entry: "vertex_normals",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: VertexNormalsBindings::LIST,
    cpu: |_, slots| cpu::vertex_normals(slots.into()),
};
