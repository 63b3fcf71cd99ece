//! The first residual of a step, the diagonal, and the acceleration by the pressure with which the pressure solver starts
//! (see the [module](super)).
//!
//! Also sums, over each 64 particles, the square of the change of the velocity by all other forces.

mod cpu;

use glam::Vec4;
use splashdown_gpu::{PassDesc, WgslModule, bindings, wgsl};

use super::pair;
use crate::boundary;
use crate::cells::{GRID, Grid, ROWS};
use crate::kernel::{self, CubicSpline, Kernel, WendlandBlend};
use crate::passes::group_sum;
use crate::state::{PARAMS, Params, STATE, StepState, VISCOUS, ViscousState};

const IMPORTS: &[WgslModule] = &[
    wgsl::INDEX,
    STATE,
    VISCOUS,
    PARAMS,
    GRID,
    ROWS,
    kernel::WGSL,
    boundary::IMAGES,
    pair::WGSL,
    group_sum::WGSL,
];

bindings! {
    /// The buffers of `viscous_start.wgsl`.
    pub(super) struct StartBindings {
        params: uniform Params,
        grid: uniform Grid,
        state: uniform StepState,
        viscous: uniform ViscousState,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        sorted_velocities: read [Vec4],
        accelerations: read [Vec4],
        solid_gradients: read [Vec4],
        iterates: write [Vec4],
        viscous_residuals: write [Vec4],
        impulses: write [Vec4],
    }
}

/// With the Wendland C2 kernel.
pub static WENDLAND_C2: PassDesc = PassDesc {
    label: "viscous.start.wendland_c2",
    wgsl: include_str!("viscous_start.wgsl"),
    imports: IMPORTS,
    entry: "viscous_start",
    workgroup_size: [64, 1, 1],
    constants: &[("KERNEL", 0.0)],
    bindings: StartBindings::LIST,
    cpu: |_, slots| cpu::start::<kernel::WendlandC2, false>(slots.into()),
};

/// With the blend of Wendland's functions.
pub static WENDLAND_BLEND: PassDesc = PassDesc {
    label: "viscous.start.wendland_blend",
    constants: &[("KERNEL", WendlandBlend::ID as f64)],
    cpu: |_, slots| cpu::start::<WendlandBlend, false>(slots.into()),
    ..WENDLAND_C2
};

/// With the cubic spline.
pub static CUBIC_SPLINE: PassDesc = PassDesc {
    label: "viscous.start.cubic_spline",
    constants: &[("KERNEL", CubicSpline::ID as f64)],
    cpu: |_, slots| cpu::start::<CubicSpline, false>(slots.into()),
    ..WENDLAND_C2
};

/// With the Wendland C2 kernel and bodies.
pub static WENDLAND_C2_BODIES: PassDesc = PassDesc {
    label: "viscous.start.wendland_c2.bodies",
    constants: &[("KERNEL", 0.0), ("BODIES", 1.0)],
    cpu: |_, slots| cpu::start::<kernel::WendlandC2, true>(slots.into()),
    ..WENDLAND_C2
};

/// With the blend of Wendland's functions and bodies.
pub static WENDLAND_BLEND_BODIES: PassDesc = PassDesc {
    label: "viscous.start.wendland_blend.bodies",
    constants: &[("KERNEL", WendlandBlend::ID as f64), ("BODIES", 1.0)],
    cpu: |_, slots| cpu::start::<WendlandBlend, true>(slots.into()),
    ..WENDLAND_C2
};

/// With the cubic spline and bodies.
pub static CUBIC_SPLINE_BODIES: PassDesc = PassDesc {
    label: "viscous.start.cubic_spline.bodies",
    constants: &[("KERNEL", CubicSpline::ID as f64), ("BODIES", 1.0)],
    cpu: |_, slots| cpu::start::<CubicSpline, true>(slots.into()),
    ..WENDLAND_C2
};
