//! Marks the blocks within reach of particles.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use crate::cells::Grid;
use crate::surface::modules::{GRID, LATTICE, STATUS};
use crate::surface::params::Lattice;

pub(crate) static MARK: PassDesc = PassDesc {
    label: "surface.mark",
    wgsl: include_str!("mark.wgsl"),
    imports: &[wgsl::INDEX, GRID, STATUS, LATTICE],
    entry: "mark",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Lattice>("lattice"),
        uniform::<Grid>("grid"),
        read::<u32>("cell_start"),
        read::<Vec4>("positions"),
        write::<u32>("marks"),
    ],
    cpu: cpu::mark,
};
