//! Adds every triangle to the one-rings of its three vertices, in any order. Decrements the
//! valences to zero.

mod cpu;

use glam::UVec2;
use splashdown_gpu::{PassDesc, read, wgsl, write};

use crate::surface::modules::STATUS;
use crate::surface::params::Status;

pub(crate) static ONE_RING: PassDesc = PassDesc {
    label: "surface.one_ring",
    wgsl: include_str!("one_ring.wgsl"),
    imports: &[wgsl::INDEX, STATUS],
    entry: "one_ring",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        read::<Status>("status"),
        read::<u32>("indices"),
        read::<u32>("one_ring_starts"),
        write::<u32>("valences"),
        write::<UVec2>("one_rings"),
    ],
    cpu: cpu::one_ring,
};
