//! Accelerations of weakly compressible SPH.
//!
//! Per neighbour, with V = m / rho0, x = x_i - x_j, v = v_i - v_j and h = H / 2:
//!
//! * pressure: -m (p_i/rho_i^2 + p_j/rho_j^2) grad W (Monaghan 1992), which conserves momentum;
//! * laminar viscosity: 10 nu V (v.x) / (r^2 + 0.01 H^2) grad W (Monaghan 2005), which conserves angular momentum too;
//!   V uses rho0 instead of rho_j, so that the two forces of a pair are equal;
//! * artificial viscosity for approaching pairs: alpha c0 h V (v.x) / (r^2 + 0.01 H^2) grad W (Monaghan 1992);
//! * surface tension: -gamma 2 rho0/(rho_i + rho_j) [m C(r) x/r + (n_i - n_j)] (Akinci, Akinci & Teschner 2013).
//!
//! The sums include the images behind walls. The pressure of an image is extrapolated.
//! Walls with friction add `boundary::wall_friction`.

pub(crate) mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{FORCES, TENSION};
use crate::boundary::{self, KernelPair, part};
use crate::cells::{CANDIDATES, GRID, Grid, ROWS};
use crate::kernel::{self, CubicSpline, Kernel, WendlandBlend};
use crate::state::{PARAMS, Params, STATE, StepState};

bindings! {
    /// The buffers of `acceleration.wgsl`.
    pub(super) struct AccelerationBindings {
        params: uniform Params,
        grid: uniform Grid,
        state: read StepState,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        sorted_velocities: read [Vec4],
        densities: read [Vec2],
        normals: read [Vec4],
        accelerations: write [Vec4],
    }
}

/// With the Wendland C2 kernel.
pub static WENDLAND_C2: PassDesc = PassDesc {
    label: "acceleration.wendland_c2",
    wgsl: include_str!("acceleration.wgsl"),
    imports: &[
        wgsl::INDEX,
        STATE,
        PARAMS,
        GRID,
        ROWS,
        kernel::WGSL,
        boundary::IMAGES,
        CANDIDATES,
        boundary::PLANES,
        boundary::LAW,
        boundary::WALL_FRICTION,
        TENSION,
        FORCES,
    ],
    entry: "acceleration",
    workgroup_size: [64, 1, 1],
    constants: &[("KERNEL", 0.0), ("WALL_KERNEL", 0.0)],
    bindings: AccelerationBindings::LIST,
    cpu: |_, slots| cpu::acceleration::<kernel::WendlandC2, { part::ALL }>(slots.into()),
};

/// With the blend of Wendland's functions.
pub static WENDLAND_BLEND: PassDesc = PassDesc {
    label: "acceleration.wendland_blend",
    constants: &[
        ("KERNEL", WendlandBlend::ID as f64),
        ("WALL_KERNEL", KernelPair::WendlandBlend.id() as f64),
    ],
    cpu: |_, slots| cpu::acceleration::<WendlandBlend, { part::ALL }>(slots.into()),
    ..WENDLAND_C2
};

/// With the cubic spline.
pub static CUBIC_SPLINE: PassDesc = PassDesc {
    label: "acceleration.cubic_spline",
    constants: &[("KERNEL", CubicSpline::ID as f64), ("WALL_KERNEL", KernelPair::CubicSpline.id() as f64)],
    cpu: |_, slots| cpu::acceleration::<CubicSpline, { part::ALL }>(slots.into()),
    ..WENDLAND_C2
};

/// The pressure part with the Wendland C2 kernel.
pub static WENDLAND_C2_PRESSURE: PassDesc = PassDesc {
    label: "acceleration.wendland_c2.pressure",
    constants: &[("KERNEL", 0.0), ("WALL_KERNEL", 0.0), ("FORCES", part::PRESSURE as f64)],
    cpu: |_, slots| cpu::acceleration::<kernel::WendlandC2, { part::PRESSURE }>(slots.into()),
    ..WENDLAND_C2
};

/// The pressure part with the blend of Wendland's functions.
pub static WENDLAND_BLEND_PRESSURE: PassDesc = PassDesc {
    label: "acceleration.wendland_blend.pressure",
    constants: &[
        ("KERNEL", WendlandBlend::ID as f64),
        ("WALL_KERNEL", KernelPair::WendlandBlend.id() as f64),
        ("FORCES", part::PRESSURE as f64),
    ],
    cpu: |_, slots| cpu::acceleration::<WendlandBlend, { part::PRESSURE }>(slots.into()),
    ..WENDLAND_C2
};

/// The pressure part with the cubic spline.
pub static CUBIC_SPLINE_PRESSURE: PassDesc = PassDesc {
    label: "acceleration.cubic_spline.pressure",
    constants: &[
        ("KERNEL", CubicSpline::ID as f64),
        ("WALL_KERNEL", KernelPair::CubicSpline.id() as f64),
        ("FORCES", part::PRESSURE as f64),
    ],
    cpu: |_, slots| cpu::acceleration::<CubicSpline, { part::PRESSURE }>(slots.into()),
    ..WENDLAND_C2
};

/// The other forces with the blend of Wendland's functions.
pub static WENDLAND_BLEND_OTHER: PassDesc = PassDesc {
    label: "acceleration.wendland_blend.other",
    constants: &[
        ("KERNEL", WendlandBlend::ID as f64),
        ("WALL_KERNEL", KernelPair::WendlandBlend.id() as f64),
        ("FORCES", part::OTHER as f64),
    ],
    cpu: |_, slots| cpu::acceleration::<WendlandBlend, { part::OTHER }>(slots.into()),
    ..WENDLAND_C2
};

/// The other forces with the cubic spline.
pub static CUBIC_SPLINE_OTHER: PassDesc = PassDesc {
    label: "acceleration.cubic_spline.other",
    constants: &[
        ("KERNEL", CubicSpline::ID as f64),
        ("WALL_KERNEL", KernelPair::CubicSpline.id() as f64),
        ("FORCES", part::OTHER as f64),
    ],
    cpu: |_, slots| cpu::acceleration::<CubicSpline, { part::OTHER }>(slots.into()),
    ..WENDLAND_C2
};

/// The other forces with the Wendland C2 kernel.
pub static WENDLAND_C2_OTHER: PassDesc = PassDesc {
    label: "acceleration.wendland_c2.other",
    constants: &[("KERNEL", 0.0), ("WALL_KERNEL", 0.0), ("FORCES", part::OTHER as f64)],
    cpu: |_, slots| cpu::acceleration::<kernel::WendlandC2, { part::OTHER }>(slots.into()),
    ..WENDLAND_C2
};
