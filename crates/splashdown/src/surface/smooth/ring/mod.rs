//! Puts every triangle into the rings of its three corners, in any order; the valences count down to zero on
//! the way.

mod cpu;

use glam::UVec2;
use splashdown_gpu::{PassDesc, read, wgsl, write};

use crate::surface::modules::STATUS;
use crate::surface::params::Status;

pub(crate) static RING: PassDesc = PassDesc {
    label: "surface.ring",
    wgsl: include_str!("ring.wgsl"),
    imports: &[wgsl::INDEX, STATUS],
    entry: "ring",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        read::<Status>("status"),
        read::<u32>("indices"),
        read::<u32>("ring_starts"),
        write::<u32>("valences"),
        write::<UVec2>("rings"),
    ],
    cpu: cpu::ring,
};
