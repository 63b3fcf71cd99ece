//! The forces of a boundary on a particle, apart from pressure: friction and contact of walls and bodies, and the
//! damping of the approach to bodies.
//!
//! Velocities are relative to the boundary. The WGSL side is `law.wgsl`.

use glam::Vec3;

use crate::state::Params;

/// The smallest distance of a particle from a boundary, in spacings. A particle that would come nearer within a step
/// loses the part of its velocity that would carry it there.
pub(crate) const CLEARANCE: f32 = 0.25;

/// The rate in 1/s at which the velocity towards a body is damped, at a distance q in support radii:
/// k = c0 H B with B = 7 (1-q)^5 (1+2q) / H^2, the Morris operator over a solid at rest. Zero where the density is
/// integrated.
#[inline(always)]
pub(crate) fn approach_damping(params: &Params, q: f32) -> f32 {
    let scale = 1.0 / params.support_radius;
    let t = 1.0 - q;
    params.approach_damping_factor * 7.0 * params.sound_speed * scale * t * t * t * t * t * (1.0 + 2.0 * q)
}

/// The rate in 1/s at which the velocity along a boundary is damped: k = 2 nu A / (H d), the closed form for a velocity
/// that is linear across the boundary. `friction` is 0 for free slip and 1 for no slip, `viscosity` in m^2/s, `gradient`
/// the gradient A / H of the kernel fraction in 1/m, `distance` in m.
#[inline(always)]
pub(crate) fn friction(params: &Params, friction: f32, viscosity: f32, gradient: f32, distance: f32) -> f32 {
    friction * 2.0 * viscosity * gradient / distance.max(CLEARANCE * params.particle_spacing)
}

/// The effective rate of an implicit step for a damping rate k in 1/s: k / (1 + k dt). It is stable for any k.
#[inline(always)]
pub(crate) fn implicit_rate(k: f32, dt: f32) -> f32 {
    k / (1.0 + k * dt)
}

/// The change of the relative velocity of fluid and a body, over that of the fluid alone, if a layer of fluid as thick as the
/// [`CLEARANCE`] is stopped by the whole surface of the body: 1 for a body that does not yield. `coupling` is that of the
/// [`Body`](crate::bodies::Body).
///
/// Each particle stops its own approach within a step and does not know of the others. Without the division by this factor
/// they push a light body many times as fast as the fluid. It meets the fluid on its other side, and both burst at any length
/// of the step.
#[inline(always)]
pub(crate) fn yielding(params: &Params, coupling: f32) -> f32 {
    1.0 + CLEARANCE * params.rest_density * params.particle_spacing * coupling
}

/// The largest speed towards a boundary at this distance, in m/s, that respects the [`CLEARANCE`] after a step.
#[inline(always)]
pub(crate) fn contact_speed(params: &Params, distance: f32, dt: f32) -> f32 {
    contact_speeds(params, Vec3::splat(distance), dt).x
}

/// [`contact_speed`] for the distances of three planes.
#[inline(always)]
pub(crate) fn contact_speeds(params: &Params, distances: Vec3, dt: f32) -> Vec3 {
    (distances - Vec3::splat(CLEARANCE * params.particle_spacing)).max(Vec3::ZERO) / dt
}
