//! The normals of the smoothed mesh: those of the triangles round a vertex, weighted by area.

mod cpu;

use glam::{UVec2, Vec4};
use splashdown_gpu::{PassDesc, read, wgsl, write};

use crate::surface::modules::STATUS;
use crate::surface::params::Status;

pub(crate) static SHADE: PassDesc = PassDesc {
    label: "surface.shade",
    wgsl: include_str!("shade.wgsl"),
    imports: &[wgsl::INDEX, STATUS],
    entry: "shade",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        read::<Status>("status"),
        read::<u32>("ring_starts"),
        read::<UVec2>("rings"),
        read::<Vec4>("positions"),
        write::<Vec4>("normals"),
    ],
    cpu: cpu::shade,
};
