//! The continuum surface force for a liquid with a free surface (Brackbill, Kothe & Zemach 1992; Morris 2000), balanced
//! with the pressure force (Francois et al. 2006).
//!
//! a_i = w_i sigma kappa_i / rho0 sum_j V (B_i + B_j) grad W: minus the pressure force by a uniform pressure sigma kappa,
//! with the matrices B of `passes::correction` where the pressure force has them. A drop of any shape with a uniform
//! curvature is therefore in equilibrium with the pressure of Laplace, whatever the arrangement of its particles, if no
//! particles are close (see *Pairs*).
//! w_i fades out where the normal is short, inside the fluid.
//!
//! The curvature, the sum of both principal ones (2 / R for a ball), is that of the unit vectors u = n / |n| of
//! `passes::smooth_normals`, which point into the fluid:
//!
//! kappa_i = 2 sum_j w_j g (u_j - u_i) . d / sum_j w_j g (d^2 - (d . u_i)^2), grad W = g d, d = x_i - x_j.
//!
//! The denominator is the numerator of a surface with the curvature 2 at the same neighbours, so that missing neighbours do not
//! reduce the curvature. The particles that count lie at a mean depth z below the surface. There a ball has the curvature
//! kappa, and 1 / (1 / kappa + z / 2) at its surface.
//!
//! *Pairs* (`dfsph` only). In the first layers this force exceeds the pressure force, so that each particle is attracted by its
//! neighbours as by a negative pressure, and particles pair up. `continuity` separates them by shifting. With the implicit
//! pressure, neighbours with q = |d| / H below 1/4, the distance from which the gradient of Wendland C2 decreases towards zero, repel
//! the particle: the sum over them of 4 (1 - 4 q) V (B_i + B_j) grad W, times w_i sigma |kappa_i| / rho0, is subtracted. Where the
//! curvature is positive, a pair attracts as in the first formula at q = 1/4, not at all at q = 3/16, and repels below.
//!
//! Images have reflected normals, so that the surface meets walls at a right angle: without the energy of wetting, the
//! surface and its image are one smooth surface.
//!
//! *Contact angle* from 90 degrees (Young 1805). Fluid that covers a side has the energy -sigma cos(theta) per area, so that the
//! side pushes the contact line with this force per length, along the side and towards the fluid. As in the model of Huber et al.
//! (2016), the force is distributed over the particles of the surface near the side: it is the force above with -cos(theta) f(z) in
//! place of kappa, without its part across the side. f falls linearly from 2 / H at the side to zero at the support radius
//! H, and its integral is one. The forces along a closed contact line add up to zero, except for the errors of the sum over
//! neighbours. Below 90 degrees the force would pull particles off the fluid.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::boundary;
use crate::cells::{GRID, Grid, ROWS};
use crate::kernel::{self, CubicSpline, Kernel, WendlandBlend};
use crate::state::{PARAMS, Params, STATE, SYMMETRIC};

bindings! {
    /// The buffers of `tension_force.wgsl`.
    pub(super) struct TensionForceBindings {
        params: uniform Params,
        grid: uniform Grid,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        normals: read [Vec4],
        smooth_normals: read [Vec4],
        corrections: read [Vec4],
        accelerations: write [Vec4],
    }
}

/// The distance over the support radius below which two particles repel each other, and how strongly at a distance of zero.
const CLOSE: f32 = 0.25;
const REPULSION: f32 = 4.0;

/// With the Wendland C2 kernel.
pub static WENDLAND_C2: PassDesc = PassDesc {
    label: "tension_force.wendland_c2",
    wgsl: include_str!("tension_force.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, GRID, ROWS, kernel::WGSL, boundary::IMAGES, SYMMETRIC],
    entry: "tension_force",
    workgroup_size: [64, 1, 1],
    constants: &[("KERNEL", 0.0), ("CORRECTED", 0.0)],
    bindings: TensionForceBindings::LIST,
    cpu: |_, slots| cpu::tension_force::<kernel::WendlandC2, false>(slots.into()),
};

/// With the blend of Wendland's functions.
pub static WENDLAND_BLEND: PassDesc = PassDesc {
    label: "tension_force.wendland_blend",
    constants: &[("KERNEL", WendlandBlend::ID as f64), ("CORRECTED", 0.0)],
    cpu: |_, slots| cpu::tension_force::<WendlandBlend, false>(slots.into()),
    ..WENDLAND_C2
};

/// With the cubic spline.
pub static CUBIC_SPLINE: PassDesc = PassDesc {
    label: "tension_force.cubic_spline",
    constants: &[("KERNEL", CubicSpline::ID as f64), ("CORRECTED", 0.0)],
    cpu: |_, slots| cpu::tension_force::<CubicSpline, false>(slots.into()),
    ..WENDLAND_C2
};

/// With the Wendland C2 kernel and corrected gradients.
pub static WENDLAND_C2_CORRECTED: PassDesc = PassDesc {
    label: "tension_force.wendland_c2_corrected",
    constants: &[("KERNEL", 0.0), ("CORRECTED", 1.0)],
    cpu: |_, slots| cpu::tension_force::<kernel::WendlandC2, true>(slots.into()),
    ..WENDLAND_C2
};

/// With the blend of Wendland's functions and corrected gradients.
pub static WENDLAND_BLEND_CORRECTED: PassDesc = PassDesc {
    label: "tension_force.wendland_blend_corrected",
    constants: &[("KERNEL", WendlandBlend::ID as f64), ("CORRECTED", 1.0)],
    cpu: |_, slots| cpu::tension_force::<WendlandBlend, true>(slots.into()),
    ..WENDLAND_C2
};

/// With the cubic spline and corrected gradients.
pub static CUBIC_SPLINE_CORRECTED: PassDesc = PassDesc {
    label: "tension_force.cubic_spline_corrected",
    constants: &[("KERNEL", CubicSpline::ID as f64), ("CORRECTED", 1.0)],
    cpu: |_, slots| cpu::tension_force::<CubicSpline, true>(slots.into()),
    ..WENDLAND_C2
};
