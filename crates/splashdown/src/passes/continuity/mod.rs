//! Density by the continuity equation, and the resulting pressure.
//!
//! ```text
//! d rho_i / dt = rho_i sum (m/rho_j) v.grad W
//!              + 2 delta h c0 sum (m/rho_j) psi_ij (x_j - x_i).grad W / (r^2 + 0.01 H^2)
//! ```
//!
//! with v = v_i - v_j and h = H / 2. The second term is the diffusion of Molteni & Colagrossi (2009), where psi_ij is
//! rho_j - rho_i minus the hydrostatic difference (Fourtakas et al. 2019). The sums include the
//! images behind walls.
//!
//! The density is advanced first with the old velocities, and the velocities then with the pressure of the new density,
//! which is symplectic for sound waves. Advancing both from the old state, as explicit Euler does, would amplify every
//! sound wave by (omega dt)^2 / 2 per step.

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::boundary;
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
        densities: write [Vec2],
    }
}

/// With the Wendland C2 kernel.
pub static WENDLAND_C2: PassDesc = PassDesc {
    label: "continuity.wendland_c2",
    wgsl: include_str!("continuity.wgsl"),
    imports: &[wgsl::INDEX, STATE, PARAMS, GRID, ROWS, kernel::WGSL, boundary::IMAGES],
    entry: "continuity",
    workgroup_size: [64, 1, 1],
    constants: &[("KERNEL", 0.0)],
    bindings: ContinuityBindings::LIST,
    cpu: |_, slots| cpu::continuity::<kernel::WendlandC2>(slots.into()),
};

/// With the cubic spline.
pub static CUBIC_SPLINE: PassDesc = PassDesc {
    label: "continuity.cubic_spline",
    constants: &[("KERNEL", CubicSpline::ID as f64)],
    cpu: |_, slots| cpu::continuity::<CubicSpline>(slots.into()),
    ..WENDLAND_C2
};
