//! Lists the marked blocks in the order of the dense table.

mod cpu;

use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use crate::surface::modules::{LATTICE, STATUS};
use crate::surface::params::Lattice;

pub(crate) static COMPACT: PassDesc = PassDesc {
    label: "surface.compact",
    wgsl: include_str!("compact.wgsl"),
    imports: &[wgsl::INDEX, STATUS, LATTICE],
    entry: "compact",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Lattice>("lattice"),
        read::<u32>("marks"),
        read::<u32>("mark_starts"),
        write::<u32>("block_list"),
        write::<u32>("block_slot"),
    ],
    cpu: cpu::compact,
};
