//! The passes of the implicit pressure of `dfsph`.
//!
//! # The system
//! With V = m / rho0, delta_i = sum_j V W_ij + lambda_i (fluid, images behind walls, and bodies), g_ij = V grad W_ij, the
//! gradient b_i of the bodies' part, and the unknown k_i = p_i rho0 / rho_i^2:
//!
//! ```text
//! (D u)_i  = sum_j g_ij . (u_i - u_j) + b_i . (u_i - u_body)      rate of the density
//! (D' k)_i = sum_j (k_i + k_j) g_ij + k_i b_i                      minus the acceleration by pressure
//! u        = v* - dt D' k                                          v*: the velocity by all other forces
//! r        = e + s + dt D u - k / c^2             the excess of density at the end of the step, less the compression
//! ```
//!
//! e is delta - 1, or the part of it that a step removes if it is large, and s completes the density at the free surface
//! ([`residual`]); forces and diagonal do not contain its derivative.
//!
//! The solution has k >= 0, r <= 0 and k r = 0. Inside the fluid it may be a small tension, which closes a deficit of density
//! slowly: [`residual`] states its limits. An image has the pressure of its particle and reflects its velocity; a body
//! counts twice in b, because it reflects the fluid. So D' is the adjoint of D, the matrix dt^2 D D' + 1 / c^2 is symmetric
//! and positive definite, and the forces conserve momentum. A dynamic body is a part of the system: its velocity in D is
//! the one that the pressure gives it. The compressibility 1 / c^2 is too small to matter except in a sealed space: it
//! bounds the pressure there.
//!
//! Where fluid fills a closed domain, the compressibility is larger, and the mean excess of density is accepted up to a limit,
//! because no pressure can take it away. The first iteration measures it and keeps the pressures.
//!
//! # The solver
//! Nonsmooth nonlinear conjugate gradients (Silcowitz, Niebe & Erleben 2010) on the projected Jacobi map
//! k <- max(k + w r / a, 0), where a is the diagonal and w the relaxation, started with a running mean of the old pressures
//! (without tension):
//!
//! ```text
//! predict    k = max(k_J + beta p, 0);  u = v* - dt D' k
//! residual   p = beta p + g;  r = e + s + dt D u - k / c^2;  k_J = max(k + w r / a, 0);  g = k_J - k
//! decide     stop if mean |r| <= tolerance, and <= 5 tolerance in each group, where r counts if it is positive or k is;
//!            beta = sum a g^2 / (the previous sum), or 0 in the first iteration and if the sum has grown
//! ```
//!
//! After an impact that stops much of the fluid the step is shortened, once its pressure is known ([`decide`]).
//!
//! The residual is two-sided: with a one-sided one and the whole old pressure, excess pressures would be accepted and
//! energy would grow. The residual that is tested belongs to the velocity u of the same iteration, so that no further visit
//! of the neighbours follows.
//!
//! The mean alone would not see the impact of a drop on a lake: if one particle in a thousand has 1.5 times the rest density,
//! the mean is 0.05 %. The mean of each group of 64 particles that follow one another in the order of the cells is therefore
//! limited as well. A step whose groups do not meet this limit is accepted and not repeated with a shorter one, as long as
//! the mean of all does: a small pocket that is overfull must not end the run.
//!
//! A mean residual of 0.1 % allows a column of water to rise or fall by 0.1 % of its height in a step. The whole old
//! pressure alone would repeat the correction of one step in the next, and heat a tank at rest. Two corrections keep it
//! quiet, so that no divergence solve is needed:
//!
//! * the accepted pressure is scaled by theta = 1 + k.r / k.A k, so that k.r = 0: the residual then does no work. k.A k is
//!   the sum of (dt D' k)^2 + k^2 / c^2, and scaling k scales dt D' k, so this needs no visit of the neighbours;
//! * the next step starts with a running mean of the pressures. The part of the new one is |v|max dt / spacing, at least
//!   0.02, and more if the iterations were many for the residual. With an implicit viscosity it is the whole: viscosity damps
//!   the noise, and a pressure of many steps ago pushes the slow fluid apart, which then does not close its voids.
//!
//! In water deeper than five spacings the mean residual must be smaller: a residual of one sign lifts or lowers the
//! surface by the depth times the residual in every step. The depth of N spacings follows from the mean square of the
//! pressure; without gravity N is the cube root of the number of particles. The residual may be 100 times the root mean square
//! of the motions over N times the tolerance, or (5 / N)^2 times it if that is more; at least 0.02 times the tolerance and at
//! most the tolerance. With the default tolerance, 0.1 %, the first is a tenth of the motions over N.
//!
//! If the residual exceeds four times the best, the relaxation is halved and the directions restart. At the largest number
//! of iterations the pressure is accepted, the next step is shorter and starts with half of the pressure.

pub mod begin;
pub mod decide;
pub mod finish;
mod points;
pub mod predict;
pub mod residual;
pub mod system;

use splashdown_gpu::PassDesc;

/// Particles per sum.
const GROUP: usize = 64;
/// The mean residual of a group may be this many times the tolerance.
const LARGEST_IN_GROUP: f32 = 5.0;
/// Sums per task on the CPU.
const GROUPS: usize = 64;

/// The passes of this module.
pub(super) fn passes() -> [&'static PassDesc; 18] {
    [
        &system::WENDLAND_C2,
        &system::WENDLAND_BLEND,
        &system::CUBIC_SPLINE,
        &begin::BEGIN,
        &predict::WENDLAND_C2,
        &predict::WENDLAND_BLEND,
        &predict::CUBIC_SPLINE,
        &predict::WENDLAND_C2_BODIES,
        &predict::WENDLAND_BLEND_BODIES,
        &predict::CUBIC_SPLINE_BODIES,
        &residual::WENDLAND_C2,
        &residual::WENDLAND_BLEND,
        &residual::CUBIC_SPLINE,
        &residual::WENDLAND_C2_BODIES,
        &residual::WENDLAND_BLEND_BODIES,
        &residual::CUBIC_SPLINE_BODIES,
        &decide::DECIDE,
        &finish::FINISH,
    ]
}
