//! Sorts every one-ring, so that sums over it have a fixed order.

mod cpu;

use glam::UVec2;
use splashdown_gpu::{PassDesc, read, wgsl, write};

use crate::surface::modules::STATUS;
use crate::surface::params::Status;

pub(crate) static ONE_RING_ORDER: PassDesc = PassDesc {
    label: "surface.one_ring_order",
    wgsl: include_str!("one_ring_order.wgsl"),
    imports: &[wgsl::INDEX, STATUS],
    entry: "one_ring_order",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[read::<Status>("status"), read::<u32>("one_ring_starts"), write::<UVec2>("one_rings")],
    cpu: cpu::one_ring_order,
};
