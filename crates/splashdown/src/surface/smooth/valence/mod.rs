//! Counts the triangles of every vertex.

mod cpu;

use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::surface::modules::STATUS;
use crate::surface::params::Status;

bindings! {
    /// The buffers of `valence.wgsl`.
    pub(super) struct ValenceBindings {
        status: read Status,
        indices: read [u32],
        valences: atomic [u32],
    }
}

pub(crate) static VALENCE: PassDesc = PassDesc {
    label: "surface.valence",
    wgsl: include_str!("valence.wgsl"),
    imports: &[wgsl::INDEX, STATUS],
    entry: "valence",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: ValenceBindings::LIST,
    cpu: |_, slots| cpu::valence(slots.into()),
};
