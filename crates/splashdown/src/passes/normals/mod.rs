//! Normals of the fluid's free surface, for both models of surface tension (Akinci, Akinci & Teschner 2013):
//! n_i = H sum_j (m / rho_j) grad W(x_i - x_j), over fluid and images, without unit; its length
//! grows with the curvature. With images the surface meets walls at a right angle.

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::boundary;
use crate::cells::{GRID, Grid, ROWS};
use crate::kernel::{self, CubicSpline, Kernel, WendlandBlend};
use crate::state::{PARAMS, Params, STATE};

bindings! {
    /// The buffers of `surface_normals.wgsl`.
    pub(super) struct SurfaceNormalsBindings {
        params: uniform Params,
        grid: uniform Grid,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        densities: read [Vec2],
        normals: write [Vec4],
    }
}

/// With the Wendland C2 kernel.
pub static WENDLAND_C2: PassDesc = PassDesc {
    label: "normals.wendland_c2",
    wgsl: include_str!("surface_normals.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, GRID, ROWS, kernel::WGSL, boundary::IMAGES],
    entry: "surface_normals",
    workgroup_size: [64, 1, 1],
    constants: &[("KERNEL", 0.0)],
    bindings: SurfaceNormalsBindings::LIST,
    cpu: |_, slots| cpu::normals::<kernel::WendlandC2>(slots.into()),
};

/// With the blend of Wendland's functions.
pub static WENDLAND_BLEND: PassDesc = PassDesc {
    label: "normals.wendland_blend",
    constants: &[("KERNEL", WendlandBlend::ID as f64)],
    cpu: |_, slots| cpu::normals::<WendlandBlend>(slots.into()),
    ..WENDLAND_C2
};

/// With the cubic spline.
pub static CUBIC_SPLINE: PassDesc = PassDesc {
    label: "normals.cubic_spline",
    constants: &[("KERNEL", CubicSpline::ID as f64)],
    cpu: |_, slots| cpu::normals::<CubicSpline>(slots.into()),
    ..WENDLAND_C2
};
