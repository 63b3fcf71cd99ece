//! Sorts every one-ring, so that sums over it have a fixed order.

mod cpu;

use glam::UVec2;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::surface::modules::STATUS;
use crate::surface::params::Status;

bindings! {
    /// The buffers of `one_ring_order.wgsl`.
    pub(super) struct OneRingOrderBindings {
        status: read Status,
        one_ring_starts: read [u32],
        one_rings: write [UVec2],
    }
}

pub(crate) static ONE_RING_ORDER: PassDesc = PassDesc {
    label: "surface.one_ring_order",
    wgsl: include_str!("one_ring_order.wgsl"),
    imports: &[wgsl::INDEX, STATUS],
    entry: "one_ring_order",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: OneRingOrderBindings::LIST,
    cpu: |_, slots| cpu::one_ring_order(slots.into()),
};
