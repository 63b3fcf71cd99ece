//! The volume and the local density of each particle.
//!
//! The colour field is `sum_j V_j W(x - x_j)` with `V_j = m / rho_j` and `rho_j = sum_k m W(x_j -
//! x_k)`. Mass and the factor 1 / H^3 of the kernel cancel, so `V_j` is stored as `1 / sum_k w(r_jk
//! / H)` (`w`: [`CubicSpline`]) with the position. The sum includes the particle itself, so it is
//! never zero. All sums include the images behind closed sides. The local density of particle i is `sum_j max(0, 1 - r_ij^2 / H^2)` over the other
//! particles (Löschner, Böttcher, Jeske, Bender, "Weighted Laplacian smoothing for surface
//! reconstruction of particle-based fluids", 2023).

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::modules::{CANDIDATES, GRID, LATTICE, STATUS, WALLS};
use super::params::Lattice;
use crate::cells::Grid;
use crate::kernel::{self, CubicSpline, Kernel};

bindings! {
    /// The buffers of `volume.wgsl`.
    pub(super) struct VolumeBindings {
        lattice: uniform Lattice,
        grid: uniform Grid,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        samples: write [Vec4],
        local_density: write [f32],
    }
}

pub(crate) static VOLUME: PassDesc = PassDesc {
    label: "surface.volume",
    wgsl: include_str!("volume.wgsl"),
    imports: &[wgsl::INDEX, GRID, STATUS, LATTICE, WALLS, kernel::WGSL, CANDIDATES],
    entry: "volume",
    workgroup_size: [64, 1, 1],
    constants: &[("KERNEL", CubicSpline::ID as f64)],
    bindings: VolumeBindings::LIST,
    cpu: |_, slots| cpu::volume(slots.into()),
};
