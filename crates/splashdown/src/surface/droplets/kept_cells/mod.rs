//! The first of the particles that remain of every cell, and the number of droplets.

mod cpu;

use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::cells::{GRID, Grid};
use crate::surface::modules::{LATTICE, STATUS};
use crate::surface::params::Lattice;

bindings! {
    /// The buffers of `kept_cells.wgsl`.
    pub(super) struct KeptCellsBindings {
        lattice: uniform Lattice,
        grid: uniform Grid,
        cell_start: read [u32],
        kept_starts: read [u32],
        kept_cell_start: write [u32],
        droplet_count: write [u32],
    }
}

pub(crate) static KEPT_CELLS: PassDesc = PassDesc {
    label: "surface.kept_cells",
    wgsl: include_str!("kept_cells.wgsl"),
    imports: &[wgsl::INDEX, GRID, STATUS, LATTICE],
    entry: "kept_cells",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: KeptCellsBindings::LIST,
    cpu: |_, slots| cpu::kept_cells(slots.into()),
};
