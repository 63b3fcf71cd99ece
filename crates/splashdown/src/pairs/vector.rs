//! Vectors of three registers.

use glam::Vec4;

use crate::boundary::Reflection;
use crate::simd::Lanes;

/// The first three components, in every lane.
#[inline(always)]
pub(crate) fn splat<V: Lanes>(v: Vec4) -> [V; 3] {
    [V::splat(v.x), V::splat(v.y), V::splat(v.z)]
}

/// a - b.
#[inline(always)]
pub(crate) fn difference<V: Lanes>(a: [V; 3], b: [V; 3]) -> [V; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// a . b.
#[inline(always)]
pub(crate) fn dot<V: Lanes>(a: [V; 3], b: [V; 3]) -> V {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// factor a.
#[inline(always)]
pub(crate) fn scaled<V: Lanes>(factor: V, a: [V; 3]) -> [V; 3] {
    [factor * a[0], factor * a[1], factor * a[2]]
}

/// The image of a position, in every lane.
#[inline(always)]
pub(crate) fn reflected_point<V: Lanes>(by: &Reflection, x: [V; 3]) -> [V; 3] {
    let [a, b, c] = reflected(by, x);
    [a + V::splat(by.shift.x), b + V::splat(by.shift.y), c + V::splat(by.shift.z)]
}

/// The image of a velocity or another vector, in every lane.
#[inline(always)]
pub(crate) fn reflected<V: Lanes>(by: &Reflection, v: [V; 3]) -> [V; 3] {
    [v[0] * V::splat(by.sign.x), v[1] * V::splat(by.sign.y), v[2] * V::splat(by.sign.z)]
}

/// The image of a symmetric matrix (xx, xy, xz, yy, yz, zz), in every lane.
#[inline(always)]
pub(crate) fn reflected_matrix<V: Lanes>(by: &Reflection, [xx, xy, xz, yy, yz, zz]: [V; 6]) -> [V; 6] {
    let sign = by.sign;
    [xx, xy * (sign.x * sign.y), xz * (sign.x * sign.z), yy, yz * (sign.y * sign.z), zz]
}

/// The pressure of an image, or a multiple of it, for that of the particle and the hydrostatic difference: not below the
/// smaller of zero and the particle's pressure.
#[inline(always)]
pub(crate) fn extrapolated<V: Lanes>(pressure: V, more: V) -> V {
    let zero = V::splat(0.0);
    (pressure + more).max(pressure.if_less(zero, pressure, zero))
}
