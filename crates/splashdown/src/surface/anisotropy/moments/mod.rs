//! The number, the mean offset and the covariance of the neighbours of each particle, and its local density.
//!
//! Three vectors per particle in units of the support radius: (mean offset, number), (xx, xy, xz, yy), (yz, zz) of the
//! covariance with the weight that the particle has in the field of balls. The local density is that of [`volume`](crate::surface::volume).

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::cells::Grid;
use crate::kernel::{self, CubicSpline, Kernel};
use crate::surface::modules::{CANDIDATES, GRID, LATTICE, STATUS, WALLS};
use crate::surface::params::Lattice;

bindings! {
    /// The buffers of `moments.wgsl`.
    pub(super) struct MomentsBindings {
        lattice: uniform Lattice,
        grid: uniform Grid,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        neighbour_moments: write [Vec4],
        local_density: write [f32],
    }
}

pub(crate) static MOMENTS: PassDesc = PassDesc {
    label: "surface.moments",
    wgsl: include_str!("moments.wgsl"),
    imports: &[wgsl::INDEX, GRID, STATUS, LATTICE, WALLS, kernel::WGSL, CANDIDATES],
    entry: "moments",
    workgroup_size: [64, 1, 1],
    constants: &[("KERNEL", CubicSpline::ID as f64)],
    bindings: MomentsBindings::LIST,
    cpu: |_, slots| cpu::moments(slots.into()),
};
