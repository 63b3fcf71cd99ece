//! Density by the continuity equation with corrected gradients, and the resulting pressure.
//!
//! ```text
//! d rho_i / dt = rho_i sum (m/rho_j) v.(B_i grad W)
//!              + 2 delta h c0 sum (m/rho_j) psi_ij (x_j - x_i).grad W / (r^2 + 0.01 H^2)
//!              + rho_i R_i
//! ```
//!
//! with v = v_i - v_j and h = H / 2, and the matrix B_i of `passes::correction`, for which the
//! divergence of a linear velocity field is exact. The second term is the diffusion of Molteni & Colagrossi (2009),
//! where psi_ij is rho_j - rho_i minus the hydrostatic difference (Fourtakas et al. 2019). R is the
//! recovery of the volume (`correction::volume_recovery`). The sums include the images behind walls. A fragment then loses
//! its tension (`without_tension`).
//!
//! Near a body, the body is a part of the sum M across its surface. Along the surface the divergence uses the fluid
//! alone. Bodies contribute to the density afterwards. The matrix for the forces fades to that of a lattice where a body
//! fills a twentieth of the kernel: M is a sum over particles on one side and an integral on the other, which differ by a
//! few per cent. With the inverse of M the layers next to the surface would have different pressures at rest, and the
//! first layer would slide along a vertical surface at a twentieth of gravity.
//!
//! The pass writes two vectors per particle for the forces: xx, yy, zz of B and the coefficient of the shifting; then
//! xy, xz, yz of B. The shifting and R fade out near bodies, whose parts in their sums are not known: they are zero
//! where a body fills a hundredth of the kernel. At a support of three spacings that includes the second layer, which the
//! shifting would press on the first.
//!
//! The density is advanced first with the old velocities, and the velocities then with the pressure of the new density,
//! which is symplectic for sound waves. Advancing both from the old state, as explicit Euler does, would amplify every
//! sound wave by (omega dt)^2 / 2 per step.

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::correction;
use crate::boundary;
use crate::cells::{CANDIDATES, GRID, Grid, ROWS};
use crate::kernel::{self, CubicSpline, Kernel, WendlandBlend};
use crate::state::{PARAMS, Params, STATE, SYMMETRIC, StepState};

bindings! {
    /// The buffers of `continuity.wgsl`.
    pub(super) struct ContinuityBindings {
        params: uniform Params,
        grid: uniform Grid,
        state: read StepState,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        sorted_velocities: read [Vec4],
        boundary_matrices: read [Vec4],
        densities: write [Vec2],
        corrections: write [Vec4],
    }
}

/// With the Wendland C2 kernel.
pub static WENDLAND_C2: PassDesc = PassDesc {
    label: "continuity.wendland_c2",
    wgsl: include_str!("continuity.wgsl"),
    imports: &[
        wgsl::INDEX,
        STATE,
        PARAMS,
        GRID,
        ROWS,
        kernel::WGSL,
        boundary::IMAGES,
        CANDIDATES,
        SYMMETRIC,
        correction::WGSL,
    ],
    entry: "continuity",
    workgroup_size: [64, 1, 1],
    constants: &[("KERNEL", 0.0)],
    bindings: ContinuityBindings::LIST,
    cpu: |_, slots| cpu::continuity::<kernel::WendlandC2, false>(slots.into()),
};

/// With the blend of Wendland's functions.
pub static WENDLAND_BLEND: PassDesc = PassDesc {
    label: "continuity.wendland_blend",
    constants: &[("KERNEL", WendlandBlend::ID as f64)],
    cpu: |_, slots| cpu::continuity::<WendlandBlend, false>(slots.into()),
    ..WENDLAND_C2
};

/// With the cubic spline.
pub static CUBIC_SPLINE: PassDesc = PassDesc {
    label: "continuity.cubic_spline",
    constants: &[("KERNEL", CubicSpline::ID as f64)],
    cpu: |_, slots| cpu::continuity::<CubicSpline, false>(slots.into()),
    ..WENDLAND_C2
};

/// With the Wendland C2 kernel and bodies.
pub static WENDLAND_C2_BODIES: PassDesc = PassDesc {
    label: "continuity.wendland_c2.bodies",
    constants: &[("KERNEL", 0.0), ("BODIES", 1.0)],
    cpu: |_, slots| cpu::continuity::<kernel::WendlandC2, true>(slots.into()),
    ..WENDLAND_C2
};

/// With the blend of Wendland's functions and bodies.
pub static WENDLAND_BLEND_BODIES: PassDesc = PassDesc {
    label: "continuity.wendland_blend.bodies",
    constants: &[("KERNEL", WendlandBlend::ID as f64), ("BODIES", 1.0)],
    cpu: |_, slots| cpu::continuity::<WendlandBlend, true>(slots.into()),
    ..WENDLAND_C2
};

/// With the cubic spline and bodies.
pub static CUBIC_SPLINE_BODIES: PassDesc = PassDesc {
    label: "continuity.cubic_spline.bodies",
    constants: &[("KERNEL", CubicSpline::ID as f64), ("BODIES", 1.0)],
    cpu: |_, slots| cpu::continuity::<CubicSpline, true>(slots.into()),
    ..WENDLAND_C2
};
