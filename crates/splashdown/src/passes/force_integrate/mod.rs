//! [`acceleration`](super::acceleration) and [`integrate`](super::integrate) in one pass: the accelerations are neither
//! written nor read, and position and velocity are read once.
//!
//! Used in steps without couplings (bodies, emitters, sinks, probes, mouse force) and without surface tension. The
//! fused pass and the separate ones use the same WGSL (`forces.wgsl`, `advance.wgsl`) and the same Rust. The state is
//! bound as a uniform, because a pass may bind at most eight storage buffers.

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, bindings, wgsl};

use super::{ADVANCE, FORCES};
use crate::boundary::{self, KernelPair};
use crate::cells::{CANDIDATES, CELL_COUNTS, GRID, Grid, ROWS};
use crate::kernel::{self, CubicSpline, Kernel, WendlandBlend};
use crate::state::{PARAMS, Params, STATE, STEP_COUNTERS, StepState};

bindings! {
    /// The buffers of `force_integrate.wgsl`.
    pub(super) struct ForceIntegrateBindings {
        params: uniform Params,
        grid: uniform Grid,
        state: uniform StepState,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        sorted_velocities: read [Vec4],
        densities: read [Vec2],
        positions: write [Vec4],
        velocities: write [Vec4],
        counters: atomic [u32],
        cell_counts: atomic [u32],
    }
}

/// With the Wendland C2 kernel.
pub static WENDLAND_C2: PassDesc = PassDesc {
    label: "force_integrate.wendland_c2",
    wgsl: include_str!("force_integrate.wgsl"),
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
        FORCES,
        STEP_COUNTERS,
        CELL_COUNTS,
        ADVANCE,
    ],
    entry: "force_integrate",
    workgroup_size: [64, 1, 1],
    constants: &[("KERNEL", 0.0), ("WALL_KERNEL", 0.0)],
    bindings: ForceIntegrateBindings::LIST,
    cpu: |_, slots| cpu::force_integrate::<kernel::WendlandC2>(slots.into()),
};

/// With the blend of Wendland's functions.
pub static WENDLAND_BLEND: PassDesc = PassDesc {
    label: "force_integrate.wendland_blend",
    constants: &[
        ("KERNEL", WendlandBlend::ID as f64),
        ("WALL_KERNEL", KernelPair::WendlandBlend.id() as f64),
    ],
    cpu: |_, slots| cpu::force_integrate::<WendlandBlend>(slots.into()),
    ..WENDLAND_C2
};

/// With the cubic spline.
pub static CUBIC_SPLINE: PassDesc = PassDesc {
    label: "force_integrate.cubic_spline",
    constants: &[("KERNEL", CubicSpline::ID as f64), ("WALL_KERNEL", KernelPair::CubicSpline.id() as f64)],
    cpu: |_, slots| cpu::force_integrate::<CubicSpline>(slots.into()),
    ..WENDLAND_C2
};
