//! Accelerations of Mueller, Charypar & Gross 2003, the scheme of the thesis.
//!
//! f_p = -sum m_j (p_i + p_j) / (2 rho_j) grad W_spiky; f_v = nu rho0 sum m_j (v_j - v_i) / rho_j lap W_visc; with the
//! colour field c = sum (m_j / rho_j) W_poly6 and n = grad c, f_s = -sigma lap c n / |n| where |n| > 0.5 / H. The
//! acceleration is the force density over rho_i. Its surface tension does not conserve momentum: use it to compare with
//! the thesis, not to measure.

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use crate::boundary::{self, KernelPair};
use crate::cells::{GRID, Grid, ROWS};
use crate::kernel::{self, Kernel, Spiky};
use crate::state::{PARAMS, Params, STATE, StepState};

bindings! {
    /// The buffers of `mueller.wgsl`.
    pub(super) struct MuellerBindings {
        params: uniform Params,
        grid: uniform Grid,
        state: read StepState,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        sorted_velocities: read [Vec4],
        densities: read [Vec2],
        accelerations: write [Vec4],
    }
}

/// See the module.
pub static MUELLER: PassDesc = PassDesc {
    label: "mueller",
    wgsl: include_str!("mueller.wgsl"),
    imports: &[
        wgsl::INDEX,
        STATE,
        PARAMS,
        GRID,
        ROWS,
        kernel::WGSL,
        boundary::IMAGES,
        boundary::PLANES,
        boundary::LAW,
        boundary::WALL_FRICTION,
    ],
    entry: "mueller",
    workgroup_size: [64, 1, 1],
    constants: &[("KERNEL", Spiky::ID as f64), ("WALL_KERNEL", KernelPair::Mueller.id() as f64)],
    bindings: MuellerBindings::LIST,
    cpu: |_, slots| cpu::mueller(slots.into()),
};
