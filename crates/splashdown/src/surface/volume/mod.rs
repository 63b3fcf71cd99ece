//! Each particle's share of space, and how crowded its neighbourhood is.
//!
//! The colour field is `sum_j V_j W(x - x_j)` with `V_j = m / rho_j` and `rho_j = sum_k m W(x_j - x_k)`. Mass
//! and the kernel's factor cancel, so `V_j` is stored as `1 / sum_k f(r_jk / H)` (`f`:
//! [`spline`](super::spline)) beside the position. The sum has the particle itself in it, so it is never
//! zero. Particle i's crowding is `sum_j max(0, 1 - r_ij^2 / H^2)` over the others (Löschner, Böttcher,
//! Jeske, Bender, "Weighted Laplacian smoothing for surface reconstruction of particle-based fluids", 2023).

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use super::modules::{CANDIDATES, GRID, LATTICE, SPLINE, STATUS};
use super::params::Lattice;
use crate::cells::Grid;

pub(crate) static VOLUME: PassDesc = PassDesc {
    label: "surface.volume",
    wgsl: include_str!("volume.wgsl"),
    imports: &[wgsl::INDEX, GRID, STATUS, LATTICE, SPLINE, CANDIDATES],
    entry: "volume",
    workgroup_size: [64, 1, 1],
    constants: &[],
    bindings: &[
        uniform::<Lattice>("lattice"),
        uniform::<Grid>("grid"),
        read::<u32>("cell_start"),
        read::<Vec4>("positions"),
        write::<Vec4>("samples"),
        write::<f32>("crowding"),
    ],
    cpu: cpu::volume,
};
