//! The smoothing weight of each vertex, from the local density of the particles near it. It is
//! stored in the w component of the position.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::cells::Grid;
use crate::kernel::{self, CubicSpline, Kernel};
use crate::surface::modules::{CANDIDATES, GRID, LATTICE, STATUS};
use crate::surface::params::{Lattice, Status};

bindings! {
    /// The buffers of `smoothing_weights.wgsl`.
    pub(super) struct SmoothingWeightsBindings {
        lattice: uniform Lattice,
        grid: uniform Grid,
        status: read Status,
        vertex_starts: read [u32],
        cell_start: read [u32],
        samples: read [Vec4],
        local_density: read [f32],
        vertex_positions: write [Vec4],
    }
}

pub(crate) static SMOOTHING_WEIGHTS: PassDesc = PassDesc {
    label: "surface.smoothing_weights",
    wgsl: include_str!("smoothing_weights.wgsl"),
    imports: &[wgsl::INDEX, GRID, STATUS, LATTICE, kernel::WGSL, CANDIDATES],
    entry: "smoothing_weights",
    workgroup_size: [64, 1, 1],
    constants: &[("KERNEL", CubicSpline::ID as f64)],
    bindings: SmoothingWeightsBindings::LIST,
    cpu: |_, slots| cpu::smoothing_weights(slots.into()),
};
