//! One iteration of smoothing: every vertex moves towards the mean of its neighbours by its weight.

mod cpu;

use glam::{UVec2, Vec4};
use splashdown_gpu::{PassDesc, read, wgsl, write};

use crate::surface::modules::STATUS;
use crate::surface::params::Status;

pub(crate) static RELAX: PassDesc = PassDesc {
    label: "surface.relax",
    wgsl: include_str!("relax.wgsl"),
    imports: &[wgsl::INDEX, STATUS],
    entry: "relax",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        read::<Status>("status"),
        read::<u32>("one_ring_starts"),
        read::<UVec2>("one_rings"),
        read::<Vec4>("before"),
        write::<Vec4>("after"),
    ],
    cpu: cpu::relax,
};
