//! Accelerations of weakly compressible SPH with corrected gradients, and the shifting velocities.
//!
//! Per neighbour, with V = m / rho0, x = x_i - x_j, v = v_i - v_j and h = H / 2:
//!
//! * pressure: -m (p_i/rho_i^2 B_i + p_j/rho_j^2 B_j) grad W, with the matrices of
//!   `passes::correction`. It conserves momentum. Up to the relative differences of density, and away from
//!   bodies, it is the adjoint of the divergence in [`continuity`](super::continuity) and conserves angular momentum.
//!   Without B the stress of a strained arrangement of particles is not isotropic: water would have the elasticity of a
//!   lattice;
//! * laminar viscosity and surface tension: as in [`acceleration`](super::acceleration);
//! * artificial viscosity for approaching pairs: h V c (v.x) / (r^2 + 0.01 H^2) grad W with the speed
//!   c = alpha c0 + min(3 |v.x| r / (r^2 + 0.01 H^2), c0). The second part is the dissipation of Zhang, Hu & Adams (2017)
//!   with its limit: impacts are damped, waves are not;
//! * shifting velocity: -a V (1 + 0.2 (W / W(dx))^4) grad W, with the coefficient a of
//!   `passes::correction`. It keeps the particles evenly distributed, and moves them without changing
//!   their velocity.
//!
//! The sums include the images behind walls. The pressure of an image is extrapolated.
//! Walls with friction add `boundary::wall_friction`.

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{TENSION, correction};
use crate::boundary::{self, KernelPair};
use crate::cells::{CANDIDATES, GRID, Grid, ROWS};
use crate::kernel::{self, CubicSpline, Kernel, WendlandBlend};
use crate::state::{PARAMS, Params, STATE, SYMMETRIC, StepState};

bindings! {
    /// The buffers of `corrected_acceleration.wgsl`.
    pub(super) struct CorrectedAccelerationBindings {
        params: uniform Params,
        grid: uniform Grid,
        state: uniform StepState,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        sorted_velocities: read [Vec4],
        densities: read [Vec2],
        corrections: read [Vec4],
        normals: read [Vec4],
        accelerations: write [Vec4],
        shifts: write [Vec4],
    }
}

/// With the Wendland C2 kernel.
pub static WENDLAND_C2: PassDesc = PassDesc {
    label: "corrected_acceleration.wendland_c2",
    wgsl: include_str!("corrected_acceleration.wgsl"),
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
        SYMMETRIC,
        correction::WGSL,
        TENSION,
    ],
    entry: "corrected_acceleration",
    workgroup_size: [64, 1, 1],
    constants: &[("KERNEL", 0.0), ("WALL_KERNEL", 0.0)],
    bindings: CorrectedAccelerationBindings::LIST,
    cpu: |_, slots| cpu::corrected_acceleration::<kernel::WendlandC2>(slots.into()),
};

/// With the blend of Wendland's functions.
pub static WENDLAND_BLEND: PassDesc = PassDesc {
    label: "corrected_acceleration.wendland_blend",
    constants: &[
        ("KERNEL", WendlandBlend::ID as f64),
        ("WALL_KERNEL", KernelPair::WendlandBlend.id() as f64),
    ],
    cpu: |_, slots| cpu::corrected_acceleration::<WendlandBlend>(slots.into()),
    ..WENDLAND_C2
};

/// With the cubic spline.
pub static CUBIC_SPLINE: PassDesc = PassDesc {
    label: "corrected_acceleration.cubic_spline",
    constants: &[("KERNEL", CubicSpline::ID as f64), ("WALL_KERNEL", KernelPair::CubicSpline.id() as f64)],
    cpu: |_, slots| cpu::corrected_acceleration::<CubicSpline>(slots.into()),
    ..WENDLAND_C2
};
