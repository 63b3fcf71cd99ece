//! The pressure of an iteration, and the velocity that it leads to: u = v* - dt D' k (see the [module](super)).
//!
//! Also computes, over each 64 particles, the sums of the squares of dt D' k, k and u.
//!
//! k = k_J + beta p of a neighbour is computed where it is used. It is at least zero, or the limit of the tension where k_J is
//! negative. Where a nozzle determines the motion there is no pressure, which the result marks with
//! [`SolveState::NO_PRESSURE`].

mod cpu;

use glam::{UVec4, Vec4};
use splashdown_gpu::{PassDesc, WgslModule, bindings, wgsl};

use crate::boundary;
use crate::cells::{CANDIDATES, GRID, Grid, ROWS};
use crate::kernel::{self, CubicSpline, Kernel, WendlandBlend};
use crate::passes::group_sum;
use crate::passes::neighbours::{NEIGHBOUR_ENTRIES, NEIGHBOURS};
use crate::state::{PARAMS, Params, SOLVE, STATE, SolveState, StepState};

const IMPORTS: &[WgslModule] = &[
    wgsl::INDEX,
    STATE,
    SOLVE,
    PARAMS,
    GRID,
    ROWS,
    boundary::IMAGES,
    CANDIDATES,
    NEIGHBOURS,
    NEIGHBOUR_ENTRIES,
    kernel::WGSL,
    group_sum::WGSL,
];

bindings! {
    /// The buffers of `implicit_predict.wgsl`.
    pub(super) struct PredictBindings {
        params: uniform Params,
        grid: uniform Grid,
        state: uniform StepState,
        solve: uniform SolveState,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        neighbours: read [UVec4],
        free_velocities: read [Vec4],
        solid_gradients: read [Vec4],
        iterates: read [Vec4],
        predicted: write [Vec4],
        impulses: write [Vec4],
    }
}

/// With the Wendland C2 kernel.
pub static WENDLAND_C2: PassDesc = PassDesc {
    label: "implicit.predict.wendland_c2",
    wgsl: include_str!("implicit_predict.wgsl"),
    imports: IMPORTS,
    entry: "implicit_predict",
    workgroup_size: [64, 1, 1],
    constants: &[("KERNEL", 0.0)],
    bindings: PredictBindings::LIST,
    cpu: |work, slots| cpu::predict::<kernel::WendlandC2, false>(work.scratch, slots.into()),
};

/// With the blend of Wendland's functions.
pub static WENDLAND_BLEND: PassDesc = PassDesc {
    label: "implicit.predict.wendland_blend",
    constants: &[("KERNEL", WendlandBlend::ID as f64)],
    cpu: |work, slots| cpu::predict::<WendlandBlend, false>(work.scratch, slots.into()),
    ..WENDLAND_C2
};

/// With the cubic spline.
pub static CUBIC_SPLINE: PassDesc = PassDesc {
    label: "implicit.predict.cubic_spline",
    constants: &[("KERNEL", CubicSpline::ID as f64)],
    cpu: |work, slots| cpu::predict::<CubicSpline, false>(work.scratch, slots.into()),
    ..WENDLAND_C2
};

/// With the Wendland C2 kernel and bodies.
pub static WENDLAND_C2_BODIES: PassDesc = PassDesc {
    label: "implicit.predict.wendland_c2.bodies",
    constants: &[("KERNEL", 0.0), ("BODIES", 1.0)],
    cpu: |work, slots| cpu::predict::<kernel::WendlandC2, true>(work.scratch, slots.into()),
    ..WENDLAND_C2
};

/// With the blend of Wendland's functions and bodies.
pub static WENDLAND_BLEND_BODIES: PassDesc = PassDesc {
    label: "implicit.predict.wendland_blend.bodies",
    constants: &[("KERNEL", WendlandBlend::ID as f64), ("BODIES", 1.0)],
    cpu: |work, slots| cpu::predict::<WendlandBlend, true>(work.scratch, slots.into()),
    ..WENDLAND_C2
};

/// With the cubic spline and bodies.
pub static CUBIC_SPLINE_BODIES: PassDesc = PassDesc {
    label: "implicit.predict.cubic_spline.bodies",
    constants: &[("KERNEL", CubicSpline::ID as f64), ("BODIES", 1.0)],
    cpu: |work, slots| cpu::predict::<CubicSpline, true>(work.scratch, slots.into()),
    ..WENDLAND_C2
};
