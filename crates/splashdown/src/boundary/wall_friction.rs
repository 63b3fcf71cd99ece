//! The friction of closed sides.

use glam::Vec3;

use super::{KernelPair, closed_bounds, law};
use crate::state::Params;

/// The acceleration in m/s^2 of a particle at `x` by friction along the closed sides, for its velocity `v`. The rate is
/// that of [`law::friction`], and implicit, so that it is stable for any viscosity.
#[inline]
pub(crate) fn wall_friction(params: &Params, kernels: KernelPair, x: Vec3, v: Vec3, dt: f32) -> Vec3 {
    if params.wall_friction == 0.0 {
        return Vec3::ZERO;
    }
    let [low, high] = closed_bounds(params.domain_min, params.domain_max, params.closed);
    let distances = (x - low).min(high - x).max(Vec3::ZERO);
    let mut a = Vec3::ZERO;
    for axis in 0..3 {
        let q = distances[axis] / params.support_radius;
        if q >= 1.0 {
            continue;
        }
        let gradient = kernels.gradient(q).1 / params.support_radius;
        let rate = law::friction(params, params.wall_friction, params.viscosity, gradient, distances[axis]);
        let mut along = v;
        along[axis] = 0.0;
        a -= law::implicit_rate(rate, dt) * along;
    }
    a
}
