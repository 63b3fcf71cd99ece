//! Normals of the fluid's free surface, for surface tension (Akinci, Akinci & Teschner 2013):
//! n_i = H sum_j (m / rho_j) grad W(x_i - x_j), without unit; its length grows with the curvature.

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, read, uniform, wgsl, write};

use crate::cells::{GRID, Grid, ROWS};
use crate::kernel::{self, CubicSpline, Kernel};
use crate::state::{PARAMS, Params, STATE};

/// With the Wendland C2 kernel.
pub static WENDLAND_C2: PassDesc = PassDesc {
    label: "normals.wendland_c2",
    wgsl: include_str!("normals.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, GRID, ROWS, kernel::WGSL],
    entry: "normals_of_surface",
    workgroup_size: [64, 1, 1],
    constants: &[("KERNEL", 0.0)],
    bindings: &[
        uniform::<Params>("params"),
        uniform::<Grid>("grid"),
        read::<u32>("cell_start"),
        read::<Vec4>("sorted_positions"),
        read::<Vec2>("densities"),
        write::<Vec4>("normals"),
    ],
    cpu: cpu::normals::<kernel::WendlandC2>,
};

/// With the cubic spline.
pub static CUBIC_SPLINE: PassDesc = PassDesc {
    label: "normals.cubic_spline",
    constants: &[("KERNEL", CubicSpline::ID as f64)],
    cpu: cpu::normals::<CubicSpline>,
    ..WENDLAND_C2
};
