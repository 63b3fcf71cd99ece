//! Compacts the remaining particles, in order.

mod cpu;

use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{Diffuse, FOAM, FoamState};

bindings! {
    /// The buffers of `compact.wgsl`.
    pub(super) struct CompactBindings {
        foam_state: read FoamState,
        foam_indices: read [u32],
        foam_moved: read [Diffuse],
        foam_pool: write [Diffuse],
    }
}

/// See the module.
pub static COMPACT: PassDesc = PassDesc {
    label: "foam.compact",
    wgsl: include_str!("compact.wgsl"),
    imports: &[wgsl::INDEX, FOAM],
    entry: "compact",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: CompactBindings::LIST,
    cpu: |_, slots| cpu::compact(slots.into()),
};
