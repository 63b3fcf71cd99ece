//! Vertex normals of the smoothed mesh: the normals of the adjacent triangles, weighted by area.

mod cpu;

use glam::{UVec2, Vec4};
use splashdown_gpu::{PassDesc, read, wgsl, write};

use crate::surface::modules::STATUS;
use crate::surface::params::Status;

pub(crate) static VERTEX_NORMALS: PassDesc = PassDesc {
    label: "surface.vertex_normals",
    wgsl: include_str!("vertex_normals.wgsl"),
    imports: &[wgsl::INDEX, STATUS],
    entry: "vertex_normals",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        read::<Status>("status"),
        read::<u32>("one_ring_starts"),
        read::<UVec2>("one_rings"),
        read::<Vec4>("positions"),
        write::<Vec4>("normals"),
    ],
    cpu: cpu::vertex_normals,
};
