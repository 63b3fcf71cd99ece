//! Puts those that are left together, in their order.

mod cpu;

use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{Diffuse, FOAM, FoamState};

bindings! {
    /// The buffers of `settle.wgsl`.
    pub(super) struct SettleBindings {
        foam_state: read FoamState,
        foam_indices: read [u32],
        foam_moved: read [Diffuse],
        foam_pool: write [Diffuse],
    }
}

/// See the module.
pub static SETTLE: PassDesc = PassDesc {
    label: "foam.settle",
    wgsl: include_str!("settle.wgsl"),
    imports: &[wgsl::INDEX, FOAM],
    entry: "settle",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: SettleBindings::LIST,
    cpu: |_, slots| cpu::settle(slots.into()),
};
