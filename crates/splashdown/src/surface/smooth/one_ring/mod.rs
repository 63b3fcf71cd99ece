//! Adds every triangle to the one-rings of its three vertices, in any order. Decrements the
//! valences to zero.

mod cpu;

use glam::UVec2;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::surface::modules::STATUS;
use crate::surface::params::Status;

bindings! {
    /// The buffers of `one_ring.wgsl`.
    pub(super) struct OneRingBindings {
        status: read Status,
        indices: read [u32],
        one_ring_starts: read [u32],
        valences: atomic [u32],
        one_rings: write [UVec2],
    }
}

pub(crate) static ONE_RING: PassDesc = PassDesc {
    label: "surface.one_ring",
    wgsl: include_str!("one_ring.wgsl"),
    imports: &[wgsl::INDEX, STATUS],
    entry: "one_ring",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: OneRingBindings::LIST,
    cpu: |_, slots| cpu::one_ring(slots.into()),
};
