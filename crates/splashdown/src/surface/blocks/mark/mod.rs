//! Marks the blocks within reach of particles.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::cells::Grid;
use crate::surface::modules::{GRID, LATTICE, STATUS};
use crate::surface::params::Lattice;

bindings! {
    /// The buffers of `mark.wgsl`.
    pub(super) struct MarkBindings {
        lattice: uniform Lattice,
        grid: uniform Grid,
        cell_start: read [u32],
        samples: read [Vec4],
        marks: atomic [u32],
    }
}

pub(crate) static MARK: PassDesc = PassDesc {
    label: "surface.mark",
    wgsl: include_str!("mark.wgsl"),
    imports: &[wgsl::INDEX, GRID, STATUS, LATTICE],
    entry: "mark",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: MarkBindings::LIST,
    cpu: |_, slots| cpu::mark(slots.into()),
};
