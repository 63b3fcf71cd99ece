//! Density by summation, and the resulting pressure.
//!
//! rho_i = m sum_j W(x_i - x_j) (j = i included), over fluid and images; p_i by the
//! equation of state (Batchelor 1967; Monaghan 1994).

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, WgslModule, bindings, wgsl};

use crate::boundary;
use crate::cells::{GRID, Grid, ROWS};
use crate::kernel::{self, CubicSpline, Kernel, Poly6, WendlandBlend};
use crate::state::{PARAMS, Params, STATE};

const IMPORTS: &[WgslModule] = &[wgsl::INDEX, STATE, PARAMS, GRID, ROWS, kernel::WGSL, boundary::IMAGES];

bindings! {
    /// The buffers of `density.wgsl`.
    pub(super) struct DensityBindings {
        params: uniform Params,
        grid: uniform Grid,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        densities: write [Vec2],
    }
}

/// With the Wendland C2 kernel.
pub static WENDLAND_C2: PassDesc = PassDesc {
    label: "density.wendland_c2",
    wgsl: include_str!("density.wgsl"),
    imports: IMPORTS,
    entry: "density",
    workgroup_size: [64, 1, 1],
    constants: &[("KERNEL", 0.0)],
    bindings: DensityBindings::LIST,
    cpu: |_, slots| cpu::density::<kernel::WendlandC2>(slots.into()),
};

/// With the blend of Wendland's functions.
pub static WENDLAND_BLEND: PassDesc = PassDesc {
    label: "density.wendland_blend",
    constants: &[("KERNEL", WendlandBlend::ID as f64)],
    cpu: |_, slots| cpu::density::<WendlandBlend>(slots.into()),
    ..WENDLAND_C2
};

/// With the cubic spline.
pub static CUBIC_SPLINE: PassDesc = PassDesc {
    label: "density.cubic_spline",
    constants: &[("KERNEL", CubicSpline::ID as f64)],
    cpu: |_, slots| cpu::density::<CubicSpline>(slots.into()),
    ..WENDLAND_C2
};

/// With the poly6 kernel of Mueller 2003.
pub static POLY6: PassDesc = PassDesc {
    label: "density.poly6",
    constants: &[("KERNEL", Poly6::ID as f64)],
    cpu: |_, slots| cpu::density::<Poly6>(slots.into()),
    ..WENDLAND_C2
};
