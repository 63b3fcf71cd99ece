//! Lists the marked blocks in the order of the dense table.

mod cpu;

use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::surface::modules::{LATTICE, STATUS};
use crate::surface::params::Lattice;

bindings! {
    /// The buffers of `compact.wgsl`.
    pub(super) struct CompactBindings {
        lattice: uniform Lattice,
        marks: read [u32],
        mark_starts: read [u32],
        block_list: write [u32],
        block_slot: write [u32],
    }
}

pub(crate) static COMPACT: PassDesc = PassDesc {
    label: "surface.compact",
    wgsl: include_str!("compact.wgsl"),
    imports: &[wgsl::INDEX, STATUS, LATTICE],
    entry: "compact",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: CompactBindings::LIST,
    cpu: |_, slots| cpu::compact(slots.into()),
};
