//! The smoothing weight of each vertex, from the local density of the particles near it. It is
//! stored in the w component of the position.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use crate::cells::Grid;
use crate::kernel::{self, CubicSpline, Kernel};
use crate::surface::modules::{CANDIDATES, GRID, LATTICE, STATUS};
use crate::surface::params::{Lattice, Status};

pub(crate) static SMOOTHING_WEIGHTS: PassDesc = PassDesc {
    label: "surface.smoothing_weights",
    wgsl: include_str!("smoothing_weights.wgsl"),
    imports: &[wgsl::INDEX, GRID, STATUS, LATTICE, kernel::WGSL, CANDIDATES],
    entry: "smoothing_weights",
    workgroup_size: [64, 1, 1],
    constants: &[("KERNEL", CubicSpline::ID as f64)],
    bindings: &[
        uniform::<Lattice>("lattice"),
        uniform::<Grid>("grid"),
        read::<Status>("status"),
        read::<u32>("vertex_starts"),
        read::<u32>("cell_start"),
        read::<Vec4>("samples"),
        read::<f32>("local_density"),
        write::<Vec4>("positions"),
    ],
    cpu: cpu::smoothing_weights,
};
