//! Normals of the free surface, averaged over the neighbours: sum_j W n_j / sum_j W, over fluid and images.
//!
//! The continuum surface force takes its curvature from these. Curvature from the normals themselves follows the
//! roughness of the outermost layer, which grows while the surface shrinks: the tension would then do more work than it
//! costs to stretch the surface, and a drop would oscillate ever more.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::boundary;
use crate::cells::{GRID, Grid, ROWS};
use crate::kernel::{self, CubicSpline, Kernel, WendlandBlend};
use crate::state::{PARAMS, Params, STATE};

bindings! {
    /// The buffers of `average_normals.wgsl`.
    pub(super) struct SmoothNormalsBindings {
        params: uniform Params,
        grid: uniform Grid,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        normals: read [Vec4],
        smooth_normals: write [Vec4],
    }
}

/// With the Wendland C2 kernel.
pub static WENDLAND_C2: PassDesc = PassDesc {
    label: "smooth_normals.wendland_c2",
    wgsl: include_str!("average_normals.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, GRID, ROWS, kernel::WGSL, boundary::IMAGES],
    entry: "average_normals",
    workgroup_size: [64, 1, 1],
    constants: &[("KERNEL", 0.0)],
    bindings: SmoothNormalsBindings::LIST,
    cpu: |_, slots| cpu::smooth_normals::<kernel::WendlandC2>(slots.into()),
};

/// With the blend of Wendland's functions.
pub static WENDLAND_BLEND: PassDesc = PassDesc {
    label: "smooth_normals.wendland_blend",
    constants: &[("KERNEL", WendlandBlend::ID as f64)],
    cpu: |_, slots| cpu::smooth_normals::<WendlandBlend>(slots.into()),
    ..WENDLAND_C2
};

/// With the cubic spline.
pub static CUBIC_SPLINE: PassDesc = PassDesc {
    label: "smooth_normals.cubic_spline",
    constants: &[("KERNEL", CubicSpline::ID as f64)],
    cpu: |_, slots| cpu::smooth_normals::<CubicSpline>(slots.into()),
    ..WENDLAND_C2
};
