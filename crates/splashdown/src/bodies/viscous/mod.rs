//! The friction of bodies in the implicit viscosity of [`passes::viscous`](crate::passes::viscous).
//!
//! Fluid that is sheared at a rate s along a plane wall is pulled by the fluid beyond with nu s M, where M is the integral of
//! the operator over the half-space of solid. The friction k = nu M / d along the surface holds the balance for the
//! velocity s d at the distance d, which is that of a fluid at rest at the surface:
//!
//! ```text
//! friction on particle i    k T (u_i - J_i U),   T = 1 - n n'
//! momentum of a body        M_b (U - U*) = dt sum_i m k J_i' T (u_i - J_i U)
//! ```
//!
//! with the velocity and angular velocity U of the body and the velocity J_i U of its point at the particle. A dynamic body is
//! a part of the system: its six velocities are unknowns of the conjugate gradients, with the inverse of its mass matrix
//! as the preconditioner. A light body in a viscous fluid would otherwise be unstable, because it is accelerated by many times its
//! velocity in a step. The products with its columns are sums over particles in fixed point, as its other forces.
//!
//! ```text
//! start      r -= dt k T (v - J U);  force on each body                     after `viscous.start`
//! begin      r_b = M_b (U* - U) + dt force;  z_b = r_b / M_b
//! product    dt k T (z - J z_b);  force on each body                        before `viscous.product`, which adds it
//! sum        w_b = r_b - dt force;  adds r_b.z_b and z_b.w_b to the sums    before `viscous.decide`
//! update     as `viscous.update`                                            after it
//! force      the reaction to the friction at the accepted velocities
//! ```

pub(super) mod begin;
pub(super) mod force;
mod friction;
pub(super) mod product;
pub(super) mod start;
pub(super) mod sum;
mod unknowns;
pub(super) mod update;

pub(super) use unknowns::VECTORS;

use splashdown_gpu::PassDesc;

/// The passes of this module.
pub(super) fn passes() -> [&'static PassDesc; 6] {
    [
        &start::VISCOUS_FRICTION,
        &begin::VISCOUS_BODIES,
        &product::VISCOUS_PRODUCT,
        &sum::VISCOUS_SUM,
        &update::VISCOUS_BODY_UPDATE,
        &force::VISCOUS_FORCE,
    ]
}
