//! Sorts every ring, so that sums over it have one order.

mod cpu;

use glam::UVec2;
use splashdown_gpu::{PassDesc, read, wgsl, write};

use crate::surface::modules::STATUS;
use crate::surface::params::Status;

pub(crate) static ORDER: PassDesc = PassDesc {
    label: "surface.order",
    wgsl: include_str!("order.wgsl"),
    imports: &[wgsl::INDEX, STATUS],
    entry: "order",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[read::<Status>("status"), read::<u32>("ring_starts"), write::<UVec2>("rings")],
    cpu: cpu::order,
};
