//! How far each vertex may move: from the crowding of the particles near it, into the fourth component of its
//! position.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use crate::cells::Grid;
use crate::surface::modules::{CANDIDATES, GRID, LATTICE, SPLINE, STATUS};
use crate::surface::params::{Lattice, Status};

pub(crate) static WEIGH: PassDesc = PassDesc {
    label: "surface.weigh",
    wgsl: include_str!("weigh.wgsl"),
    imports: &[wgsl::INDEX, GRID, STATUS, LATTICE, SPLINE, CANDIDATES],
    entry: "weigh",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Lattice>("lattice"),
        uniform::<Grid>("grid"),
        read::<Status>("status"),
        read::<u32>("block_list"),
        read::<u32>("vertex_starts"),
        read::<u32>("cell_start"),
        read::<Vec4>("samples"),
        read::<f32>("crowding"),
        write::<Vec4>("positions"),
    ],
    cpu: cpu::weigh,
};
