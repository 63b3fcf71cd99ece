//! Signed distances (m, negative inside) to simple shapes, and smooth Boolean operations.
//!
//! The formulas are those collected by I. Quilez ("Distance functions", "Smooth minimum"). An operation with
//! a width rounds the edge or fills the corner, so that the mesh has no jagged edges.

use glam::{Mat2, Vec2, Vec3, Vec3Swizzles as _, vec2, vec3};

/// Union; corners are filled over about `width` (m).
pub(super) fn join(a: f32, b: f32, width: f32) -> f32 {
    let overlap = (width - (a - b).abs()).max(0.0);
    a.min(b) - overlap * overlap / (4.0 * width)
}

/// Intersection; edges are rounded over about `width` (m).
pub(super) fn meet(a: f32, b: f32, width: f32) -> f32 {
    -join(-a, -b, width)
}

/// `a` without `b`; edges are rounded over about `width` (m).
pub(super) fn cut(a: f32, b: f32, width: f32) -> f32 {
    meet(a, -b, width)
}

/// An approximate distance to an ellipsoid about the origin; its zero level is exact.
pub(super) fn ellipsoid(p: Vec3, radii: Vec3) -> f32 {
    let (k0, k1) = ((p / radii).length(), (p / (radii * radii)).length());
    if k1 > 0.0 { k0 * (k0 - 1.0) / k1 } else { -radii.min_element() }
}

/// A cone from `a` to `b` with rounded ends of the given radii.
pub(super) fn bone(p: Vec3, a: Vec3, b: Vec3, radius_a: f32, radius_b: f32) -> f32 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    (p - a - t * along).length() - (radius_a + t * (radius_b - radius_a))
}

/// A box about the origin; `rounding` is the radius of its edges, inside its half edge lengths.
pub(super) fn cuboid(p: Vec3, half: Vec3, rounding: f32) -> f32 {
    let q = p.abs() - half + rounding;
    q.max(Vec3::ZERO).length() + q.max_element().min(0.0) - rounding
}

/// A rectangle about the origin with rounded corners.
pub(super) fn rectangle(p: Vec2, half: Vec2, rounding: f32) -> f32 {
    let q = p.abs() - half + rounding;
    q.max(Vec2::ZERO).length() + q.max_element().min(0.0) - rounding
}

/// A cylinder about the y axis from `low` to `high`.
pub(super) fn cylinder(p: Vec3, radius: f32, low: f32, high: f32, rounding: f32) -> f32 {
    let q = vec2(p.xz().length(), p.y - 0.5 * (low + high));
    rectangle(q, vec2(radius, 0.5 * (high - low)), rounding)
}

/// A ring about the y axis at height 0.
pub(super) fn ring(p: Vec3, radius: f32, thickness: f32) -> f32 {
    vec2(p.xz().length() - radius, p.y).length() - thickness
}

/// A polygon grown by `rounding`, which rounds its outer corners.
pub(super) fn polygon(p: Vec2, corners: &[Vec2], rounding: f32) -> f32 {
    let Some(&last) = corners.last() else { return f32::MAX };
    let (mut nearest, mut inside, mut previous) = (f32::MAX, false, last);
    for &corner in corners {
        let (edge, from) = (previous - corner, p - corner);
        let t = (from.dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
        nearest = nearest.min((from - t * edge).length_squared());
        let crosses = (corner.y > p.y) != (previous.y > p.y);
        if crosses && p.x < corner.x + (p.y - corner.y) / (previous.y - corner.y) * (previous.x - corner.x) {
            inside = !inside;
        }
        previous = corner;
    }
    let distance = nearest.sqrt();
    (if inside { -distance } else { distance }) - rounding
}

/// The solid of revolution of a profile of (radius, y) about the y axis. The profile starts and ends on the
/// axis.
pub(super) fn lathe(p: Vec3, profile: &[Vec2], rounding: f32) -> f32 {
    polygon(vec2(p.xz().length(), p.y), profile, rounding)
}

/// Closes an outline of (radius, y) with corners at negative radius, so that the axis is no edge for
/// [`lathe`].
pub(super) fn profile(outline: &[[f32; 2]]) -> Vec<Vec2> {
    let mut corners: Vec<Vec2> = outline.iter().map(|&corner| Vec2::from(corner)).collect();
    if let (Some(first), Some(last)) = (corners.first().copied(), corners.last().copied()) {
        corners.push(vec2(-1.0, last.y));
        corners.insert(0, vec2(-1.0, first.y));
    }
    corners
}

/// An extruded plane shape: `flat` is the distance in the plane, `height` the distance beyond the end faces.
pub(super) fn extrude(flat: f32, height: f32, rounding: f32) -> f32 {
    meet(flat, height, rounding)
}

/// Rotates `p` about the y axis into the first of `count` equal sectors, which is centred on +x.
pub(super) fn sector_y(p: Vec3, count: f32) -> Vec3 {
    let q = sector(p.xz(), count);
    vec3(q.x, p.y, q.y)
}

/// Rotates `p` about the origin into the first of `count` equal sectors, which is centred on +x.
pub(super) fn sector(p: Vec2, count: f32) -> Vec2 {
    let step = std::f32::consts::TAU / count;
    let turn = (p.y.atan2(p.x) / step).round() * step;
    Mat2::from_angle(-turn) * p
}

/// Rotates `p` about the y axis by an angle in degrees.
pub(super) fn turn_y(p: Vec3, degrees: f32) -> Vec3 {
    let q = Mat2::from_angle(degrees.to_radians()) * p.xz();
    vec3(q.x, p.y, q.y)
}

/// A smooth step from 0 at `low` to 1 at `high`.
pub(super) fn smooth_step(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// An approximate distance to the zero level of any function: its value divided by the length of its
/// gradient.
pub(super) fn distance_of(p: Vec3, step: f32, f: impl Fn(Vec3) -> f32) -> f32 {
    let slope = |axis: Vec3| (f(p + step * axis) - f(p - step * axis)) / (2.0 * step);
    let gradient = vec3(slope(Vec3::X), slope(Vec3::Y), slope(Vec3::Z));
    f(p) / gradient.length().max(0.5)
}
