//! One iteration of smoothing: every vertex moves towards the mean of its neighbours by its weight.

mod cpu;

use glam::{UVec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::surface::modules::STATUS;
use crate::surface::params::Status;

bindings! {
    /// The buffers of `relax.wgsl`.
    pub(super) struct RelaxBindings {
        status: read Status,
        one_ring_starts: read [u32],
        one_rings: read [UVec2],
        before: read [Vec4],
        after: write [Vec4],
    }
}

pub(crate) static RELAX: PassDesc = PassDesc {
    label: "surface.relax",
    wgsl: include_str!("relax.wgsl"),
    imports: &[wgsl::INDEX, STATUS],
    entry: "relax",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: RelaxBindings::LIST,
    cpu: |_, slots| cpu::relax(slots.into()),
};
