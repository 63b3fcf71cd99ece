//! Density by the continuity equation, and the pressure that follows from it.
//!
//! ```text
//! d rho_i / dt = rho_i sum (m/rho_j) v.grad W
//!              + 2 delta h c0 sum (m/rho_j) psi_ij (x_j - x_i).grad W / (r^2 + 0.01 H^2)
//!              + 2 rho_i v_i.G
//! ```
//!
//! with v = v_i - v_j and h = H / 2: the diffusion of Molteni & Colagrossi (2009), where psi_ij = rho_j - rho_i
//! less what hydrostatics alone makes of it (Fourtakas et al. 2019). The walls' share is twice the v_i.G of a
//! solid at rest: behind a wall stands an image of the particle, which answers its pressure in
//! [`acceleration`](super::acceleration) and moves when it moves.
//!
//! The density is advanced first, with the velocities that the particles have, and the velocities after it, with the
//! pressure of the new density: symplectic for sound. Advancing both from the old state, as explicit Euler would, makes
//! every sound wave grow by (omega dt)^2 / 2 a step.

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::boundary::{self, KernelPair};
use crate::cells::{GRID, Grid, ROWS};
use crate::kernel::{self, CubicSpline, Kernel};
use crate::state::{PARAMS, Params, STATE, StepState};

bindings! {
    /// The buffers of `continuity.wgsl`.
    pub(super) struct ContinuityBindings {
        params: uniform Params,
        grid: uniform Grid,
        state: read StepState,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        sorted_velocities: read [Vec4],
        wall_table: read [Vec4],
        densities: write [Vec2],
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
        boundary::PLANES,
        boundary::LAW,
        boundary::WGSL,
    ],
    entry: "continuity",
    workgroup_size: [64, 1, 1],
    constants: &[("KERNEL", 0.0), ("WALL_KERNEL", 0.0)],
    bindings: ContinuityBindings::LIST,
    cpu: |_, slots| cpu::continuity::<kernel::WendlandC2>(slots.into()),
};

/// With the cubic spline.
pub static CUBIC_SPLINE: PassDesc = PassDesc {
    label: "continuity.cubic_spline",
    constants: &[("KERNEL", CubicSpline::ID as f64), ("WALL_KERNEL", KernelPair::CubicSpline.id() as f64)],
    cpu: |_, slots| cpu::continuity::<CubicSpline>(slots.into()),
    ..WENDLAND_C2
};
