//! Which particles remain in the surface: 1 for them, 0 for isolated ones.

mod cpu;

pub(super) use cpu::Links;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::cells::{GRID, Grid, ROWS};
use crate::surface::modules::{LATTICE, STATUS};
use crate::surface::params::Lattice;

bindings! {
    /// The buffers of `classify.wgsl`.
    pub(super) struct ClassifyBindings {
        lattice: uniform Lattice,
        grid: uniform Grid,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        kept: write [u32],
    }
}

pub(crate) static CLASSIFY: PassDesc = PassDesc {
    label: "surface.classify",
    wgsl: include_str!("classify.wgsl"),
    imports: &[wgsl::INDEX, GRID, ROWS, STATUS, LATTICE],
    entry: "classify",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: ClassifyBindings::LIST,
    cpu: |_, slots| cpu::classify(slots.into()),
};
