//! The excess of density at the end of the step, and the next Jacobi iterate (see the [module](super)).
//!
//! Also sums, over each 64 particles, what [`decide`](super::decide) needs: the two-sided residual, the squared change of
//! the pressure in the norm of the diagonal, the excess of density of the present positions, and k r.
//!
//! # The free surface
//! A particle of the uppermost layer lacks neighbours: on a lattice its sum is 0.88 of the rest density with Wendland C2 and
//! a support of two spacings, and 0.75 with three. It would have no pressure, so that particles of the layer below would
//! move into the uppermost one until its sum is the rest density. This moves a pool at rest and takes energy from waves. What
//! the air replaces is therefore added to the density, as a function of the gradient g of the sum of V W, in which bodies
//! count once:
//!
//! ```text
//! c max(H |g| - 0.3, 0)^1.5
//! ```
//!
//! c gives the uppermost layer of a lattice the rest density. The gradients of disordered particles inside the fluid are
//! smaller than 0.3 / H, and those of an isolated particle and of a sheet of one layer are zero. The addition leads to an
//! excess of at most 2 % dt / dt_max (see below): a surface that is denser than that of a lattice, after a splash or in imported
//! particles, must spread over several steps and not burst in one. The mean excess that is reported does not contain the addition.
//!
//! The forces are those of the sum alone. If the area of the surface grows, so does the sum of what is added, and the pressure
//! k at the surface does the work k times the change. At a surface without tension k is small. With `csf` it is not, and the
//! force of the tension is larger for it (`CSF_PER_SIGMA` in `schemes/dfsph`). With the model of Akinci et al. c is zero.
//!
//! # Large excesses
//! The density is not linear in the displacement, so that the step of an impact leaves excesses of up to 40 %. The step after it
//! is short, because the pressure is large. If it removed the whole excess of a layer, all water above would be displaced by
//! up to 0.4 spacings in this short time, at several times the speed of the impact. A step therefore removes
//!
//! ```text
//! min(e, max(0.002, 2 tolerance) + 0.05 (dt / dt_max)^2)
//! ```
//!
//! of an excess e, where dt_max is the longest step without the limits by the pressure and by the frame. With the square, the
//! acceleration of a layer over an excess does not depend on the length of the step, except for the first part. That part is
//! larger than the tolerance, so that the mean residual sees it.
//!
//! # Tension
//! Inside the fluid the pressure may be negative, down to the weight of water two spacings high: k >= -2 |g| spacing. A jet
//! that falls then contracts as it gets faster. Without tension it keeps its width, and its density falls.
//!
//! The limit is small because particles under tension attract each other. A particle is inside the fluid if H |g| is below
//! 0.7, its density is above 0.7 rho0, and it is not next to a body: water that adheres to light bodies would hold them. There
//! is no tension without gravity, which gives the limit its measure, none with a model of surface tension, and none with an
//! implicit viscosity, where it would have to be far above the limit.
//!
//! A deficit e of density inside the fluid closes at a rate of sqrt(2 |g| / spacing), the speed after a fall through one spacing
//! per spacing. With c = dt sqrt(2 |g| / spacing), it is replaced by
//!
//! ```text
//! c e                        in the residual of a pressure k < 0
//! min(c e, e + 0.02)         in the residual of a pressure k > 0
//! ```
//!
//! If k is zero and neither residual asks for a pressure of its sign, it stays zero. Tension that closes a deficit in one step
//! makes particles clump. With the second line the pressure does not follow the noise of the density, and larger deficits, in
//! spray that falls together, close freely.

mod cpu;
mod limits;
mod update;

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

/// Particles with a smaller gradient of the sum of V W, times the support radius, are not at the free surface.
pub(crate) const SMALLEST_SURFACE_GRADIENT: f32 = 0.3;
/// The largest excess of density to which the addition at the free surface leads in the longest step.
const LARGEST_COMPLETED: f32 = 0.02;
/// Particles with a larger gradient of the sum of V W, times the support radius, cannot be under tension. That of the uppermost
/// layer of a lattice is 0.98.
const LARGEST_PULLED_GRADIENT: f32 = 0.7;
/// Particles with a larger deficit of density cannot be under tension: they belong to spray.
const LARGEST_PULLED_DEFICIT: f32 = 0.3;
/// Larger deficits close freely at a pressure above zero.
const LARGEST_HELD: f32 = 0.02;
/// The largest excess of density that the longest step removes besides [`LEAST_REMOVED`].
const LARGEST_REMOVED: f32 = 0.05;
/// The excess of density that every step removes; twice the tolerance, if that is larger.
const LEAST_REMOVED: f32 = 0.002;

bindings! {
    /// The buffers of `implicit_residual.wgsl`.
    pub(super) struct ResidualBindings {
        params: uniform Params,
        grid: uniform Grid,
        state: uniform StepState,
        solve: uniform SolveState,
        cell_start: read [u32],
        sorted_positions: read [Vec4],
        neighbours: read [UVec4],
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

/// With the blend of Wendland's functions.
pub static WENDLAND_BLEND: PassDesc = PassDesc {
    label: "implicit.residual.wendland_blend",
    constants: &[("KERNEL", WendlandBlend::ID as f64)],
    cpu: |work, slots| cpu::residual::<WendlandBlend, false>(work.scratch, slots.into()),
    ..WENDLAND_C2
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

/// With the blend of Wendland's functions and bodies.
pub static WENDLAND_BLEND_BODIES: PassDesc = PassDesc {
    label: "implicit.residual.wendland_blend.bodies",
    constants: &[("KERNEL", WendlandBlend::ID as f64), ("BODIES", 1.0)],
    cpu: |work, slots| cpu::residual::<WendlandBlend, true>(work.scratch, slots.into()),
    ..WENDLAND_C2
};

/// With the cubic spline and bodies.
pub static CUBIC_SPLINE_BODIES: PassDesc = PassDesc {
    label: "implicit.residual.cubic_spline.bodies",
    constants: &[("KERNEL", CubicSpline::ID as f64), ("BODIES", 1.0)],
    cpu: |work, slots| cpu::residual::<CubicSpline, true>(work.scratch, slots.into()),
    ..WENDLAND_C2
};
