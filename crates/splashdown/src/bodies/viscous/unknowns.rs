//! The unknowns of dynamic bodies.

use glam::{Vec3, Vec4, Vec4Swizzles};
use splashdown_gpu::WgslModule;

use crate::bodies::types::Body;

/// The WGSL side.
pub(super) const WGSL: WgslModule =
    WgslModule { name: "sph/viscous_unknowns", source: include_str!("unknowns.wgsl") };
/// The WGSL side of [`set`]; imports [`WGSL`].
pub(super) const SET: WgslModule =
    WgslModule { name: "sph/viscous_set_unknown", source: include_str!("set_unknown.wgsl") };

/// Vectors per body in the buffer of unknowns: a linear and an angular one of each quantity.
pub(in crate::bodies) const VECTORS: usize = 10;

/// The residual in kg m/s and kg m^2/s.
pub(super) const RESIDUAL: usize = 0;
/// The direction in which the velocities change, in m/s and 1/s.
pub(super) const DIRECTION: usize = 2;
/// The product of the matrix with it, as the residual.
pub(super) const IMAGE: usize = 4;
/// The velocities of the solution.
pub(super) const SOLUTION: usize = 6;
/// The product of the matrix with the preconditioned residual, as the residual.
pub(super) const PRODUCT: usize = 8;

/// A linear and an angular vector.
pub(super) type Pair = [Vec3; 2];

pub(super) fn get(unknowns: &[Vec4], what: usize) -> Pair {
    [unknowns[what].xyz(), unknowns[what + 1].xyz()]
}

pub(super) fn set(unknowns: &mut [Vec4], what: usize, value: Pair) {
    unknowns[what] = value[0].extend(0.0);
    unknowns[what + 1] = value[1].extend(0.0);
}

/// The velocities by an impulse: the inverse of the mass matrix. A hinged body has no inverse mass.
pub(super) fn by_impulse(body: &Body, impulse: Pair) -> Pair {
    let q = body.rotation();
    [body.inverse_mass * impulse[0], q * (body.inverse_inertia_matrix() * (q.conjugate() * impulse[1]))]
}

/// The impulse that gives these velocities.
pub(super) fn impulse_of(body: &Body, velocities: Pair) -> Pair {
    let q = body.rotation();
    let linear = if body.inverse_mass > 0.0 { velocities[0] / body.inverse_mass } else { Vec3::ZERO };
    [linear, q * (body.inertia_matrix() * (q.conjugate() * velocities[1]))]
}

pub(super) fn product(a: Pair, b: Pair) -> f32 {
    a[0].dot(b[0]) + a[1].dot(b[1])
}

/// a + factor b.
pub(super) fn plus(a: Pair, factor: f32, b: Pair) -> Pair {
    [a[0] + factor * b[0], a[1] + factor * b[1]]
}
