//! The weight of each particle: 1 / sum_j u P_j(c_i), the reciprocal of the sum of all kernels at the centre of its own.
//!
//! The weight of a particle inside the fluid is stored with a negative sign, by which the [field](crate::surface::field)
//! knows that its kernel is a ball.
//!
//! The sum includes the neighbours within the support radius; u fades from 1 to 0 at its end, between 0.87 and 1.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::cells::Grid;
use crate::kernel::{self, CubicSpline, Kernel};
use crate::surface::modules::{CANDIDATES, GRID, LATTICE, STATUS, WALLS};
use crate::surface::params::Lattice;

bindings! {
    /// The buffers of `weights.wgsl`.
    pub(super) struct WeightsBindings {
        lattice: uniform Lattice,
        grid: uniform Grid,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        kernel_centres: read [Vec4],
        kernel_matrices: read [Vec4],
        samples: write [Vec4],
    }
}

pub(crate) static WEIGHTS: PassDesc = PassDesc {
    label: "surface.weights",
    wgsl: include_str!("weights.wgsl"),
    imports: &[wgsl::INDEX, GRID, STATUS, LATTICE, WALLS, kernel::WGSL, CANDIDATES],
    entry: "weights",
    workgroup_size: [64, 1, 1],
    constants: &[("KERNEL", CubicSpline::ID as f64)],
    bindings: WeightsBindings::LIST,
    cpu: |_, slots| cpu::weights(slots.into()),
};
