//! The passes of the implicit viscosity of `dfsph`.
//!
//! # The system
//! With the viscosity nu, V = m / rho0, x_ij the distance of two particles or of a particle and an image behind a wall, and
//! v* the velocity by all other forces, the solution u has
//!
//! ```text
//! (K u)_i = nu V sum_j c(r_ij) x_ij (x_ij . u_ij) + the friction of bodies      minus the viscous acceleration
//! u + dt K u = v*,    v* = v + dt (a + a_p)
//! ```
//!
//! with c = 525 / (pi H^5) (1 - q)(1 - 4/5 q) / r^2, over a mean of lattices. This is the form of Monaghan (2005) and Weiler
//! et al. (2018) with another weight, whose reasons are in `pair`. The forces are central: momentum and angular momentum are conserved, fluid that
//! rotates as a rigid body feels none, and a free surface needs no treatment. The matrix is symmetric and positive.
//!
//! With friction a wall has images of the opposite velocity, so that the fluid comes to rest at the wall.
//!
//! a_p is the acceleration by the pressure with which the pressure solver starts, and is taken off again at the end. Without it
//! the forces of a fluid at rest would not cancel before the pressure solver: viscosity would turn gravity into a
//! circulation, of which the pressure removes only the compression.
//!
//! # The solver
//! Conjugate gradients with the diagonal (a third of the trace of its block) as the preconditioner, in the form of
//! Chronopoulos & Gear (1989), which needs one visit of the neighbours and one set of sums per iteration:
//!
//! ```text
//! start      r = v* - v - dt K v
//! product    z = r / diagonal;  w = z + dt K z;  sums of r.z, z.w, r.r, z.z
//! decide     stop if the root mean square of r is below the tolerance; beta, alpha
//! update     p = z + beta p;  s = w + beta s;  x = x + alpha p;  r = r - alpha s
//! finish     u = x + r
//! ```
//!
//! The start is the old velocity: a viscous flow changes slowly, while v* contains the whole of gravity. The tolerance is
//! relative to the change of the velocity by all other forces and to the first z. It is not relative to the first residual:
//! what the pressure has changed from particle to particle in the step before enters r with the factor dt K.
//!
//! The result is x + r = v* - dt K x and not x: the forces are those of pairs at the velocity x, so that momentum and
//! angular momentum are conserved however early the iterations end.

pub mod begin;
pub mod decide;
pub mod finish;
pub mod pair;
pub mod product;
pub mod start;
pub mod update;

use splashdown_gpu::PassDesc;

/// Particles per sum.
const GROUP: usize = 64;
/// Sums per task on the CPU.
const GROUPS: usize = 64;

/// The passes of this module.
pub(super) fn passes() -> [&'static PassDesc; 12] {
    [
        &begin::BEGIN,
        &start::WENDLAND_C2,
        &start::WENDLAND_BLEND,
        &start::CUBIC_SPLINE,
        &start::WENDLAND_C2_BODIES,
        &start::WENDLAND_BLEND_BODIES,
        &start::CUBIC_SPLINE_BODIES,
        &product::PRODUCT,
        &product::BODIES,
        &decide::DECIDE,
        &update::UPDATE,
        &finish::FINISH,
    ]
}
