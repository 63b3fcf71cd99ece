//! The excess of density at the end of the step, and the next Jacobi iterate (see the [module](super)).
//!
//! Also sums, over each 64 particles, what [`decide`](super::decide) needs: the two-sided residual, the squared change of
//! the pressure in the norm of the diagonal, the excess of density of the present positions, and k r.

mod cpu;

use glam::{Vec2, Vec4};
use splashdown_gpu::{PassDesc, WgslModule, bindings, wgsl};

use crate::boundary;
use crate::cells::{GRID, Grid, ROWS};
use crate::kernel::{self, CubicSpline, Kernel};
use crate::passes::group_sum;
use crate::state::{PARAMS, Params, SOLVE, STATE, SolveState, StepState};

const IMPORTS: &[WgslModule] =
    &[wgsl::INDEX, STATE, SOLVE, PARAMS, GRID, ROWS, kernel::WGSL, boundary::IMAGES, group_sum::WGSL];

bindings! {
    /// The buffers of `implicit_residual.wgsl`.
    pub(super) struct ResidualBindings {
        params: uniform Params,
        grid: uniform Grid,
        state: uniform StepState,
        solve: uniform SolveState,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        densities: read [Vec2],
        stiffness: read [Vec4],
        solid_gradients: read [Vec4],
        predicted: read [Vec4],
        iterates: write [Vec4],
        residuals: write [Vec4],
    }
}

/// With the Wendland C2 kernel.
pub static WENDLAND_C2: PassDesc = PassDesc {
    label: "implicit.residual.wendland_c2",
    wgsl: include_str!("implicit_residual.wgsl"),
    imports: IMPORTS,
    entry: "implicit_residual",
    workgroup_size: [64, 1, 1],
    constants: &[("KERNEL", 0.0)],
    bindings: ResidualBindings::LIST,
    cpu: |work, slots| cpu::residual::<kernel::WendlandC2, false>(work.scratch, slots.into()),
};

/// With the cubic spline.
pub static CUBIC_SPLINE: PassDesc = PassDesc {
    label: "implicit.residual.cubic_spline",
    constants: &[("KERNEL", CubicSpline::ID as f64)],
    cpu: |work, slots| cpu::residual::<CubicSpline, false>(work.scratch, slots.into()),
    ..WENDLAND_C2
};

/// With the Wendland C2 kernel and bodies.
pub static WENDLAND_C2_BODIES: PassDesc = PassDesc {
    label: "implicit.residual.wendland_c2.bodies",
    constants: &[("KERNEL", 0.0), ("BODIES", 1.0)],
    cpu: |work, slots| cpu::residual::<kernel::WendlandC2, true>(work.scratch, slots.into()),
    ..WENDLAND_C2
};

/// With the cubic spline and bodies.
pub static CUBIC_SPLINE_BODIES: PassDesc = PassDesc {
    label: "implicit.residual.cubic_spline.bodies",
    constants: &[("KERNEL", CubicSpline::ID as f64), ("BODIES", 1.0)],
    cpu: |work, slots| cpu::residual::<CubicSpline, true>(work.scratch, slots.into()),
    ..WENDLAND_C2
};
