//! Handles: three arrows along the axes that move a thing, a point on each face of a block that moves the face, and three
//! rings that rotate a mesh.

use glam::{Vec2, Vec3};

/// An axis of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis3 {
    /// To the right in a front view.
    X,
    /// Up.
    Y,
    /// To the viewer in a front view.
    Z,
}

impl Axis3 {
    /// All axes.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// The unit vector.
    pub fn vector(self) -> Vec3 {
        match self {
            Self::X => Vec3::X,
            Self::Y => Vec3::Y,
            Self::Z => Vec3::Z,
        }
    }
}

/// What a handle does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grab {
    /// Moves the thing along an axis.
    Move(Axis3),
    /// Moves the face on the side of the higher (`true`) or lower coordinate along its axis.
    Face(Axis3, bool),
    /// Rotates the thing about an axis.
    Turn(Axis3),
}

impl Grab {
    /// The axis.
    pub fn axis(self) -> Axis3 {
        match self {
            Self::Move(axis) | Self::Face(axis, _) | Self::Turn(axis) => axis,
        }
    }
}

/// The nearest handle within `reach` points of a place; `ends` are the two ends of each arrow in points.
pub fn handle_at(at: Vec2, ends: &[(Axis3, Vec2, Vec2)], reach: f32) -> Option<Axis3> {
    let distance = |&(axis, from, to): &(Axis3, Vec2, Vec2)| (axis, line_distance(at, from, to));
    let nearest = ends.iter().map(distance).min_by(|(_, a), (_, b)| a.total_cmp(b))?;
    (nearest.1 <= reach).then_some(nearest.0)
}

/// The distance of a place from a line between two others.
pub fn line_distance(at: Vec2, from: Vec2, to: Vec2) -> f32 {
    let along = to - from;
    let part = ((at - from).dot(along) / along.length_squared().max(1e-6)).clamp(0.0, 1.0);
    (from + part * along).distance(at)
}

/// How far along an axis through a point the axis is nearest to a ray, in m; `None` if they are nearly parallel.
pub fn along(point: Vec3, axis: Axis3, (origin, direction): (Vec3, Vec3)) -> Option<f32> {
    let axis = axis.vector();
    let cosine = axis.dot(direction);
    let sine2 = 1.0 - cosine * cosine;
    let between = origin - point;
    (sine2 > 0.01).then(|| (between.dot(axis) - cosine * between.dot(direction)) / sine2)
}

/// The angle in radians, right-handed about an axis through a point, at which a ray crosses the plane of the point; `None` if the
/// ray is nearly parallel to the plane, or points away from it.
pub fn angle(point: Vec3, axis: Axis3, (origin, direction): (Vec3, Vec3)) -> Option<f32> {
    let [first, second] = match axis {
        Axis3::X => [Vec3::Y, Vec3::Z],
        Axis3::Y => [Vec3::Z, Vec3::X],
        Axis3::Z => [Vec3::X, Vec3::Y],
    };
    let slope = direction.dot(axis.vector());
    let distance = (slope.abs() > 0.05).then(|| (point - origin).dot(axis.vector()) / slope)?;
    let arm = origin + distance * direction - point;
    (distance > 0.0).then(|| arm.dot(second).atan2(arm.dot(first)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_handle_is_grabbed() {
        let middle = Vec2::new(100.0, 100.0);
        let ends = [(Axis3::X, middle, middle + Vec2::X * 60.0), (Axis3::Y, middle, middle - Vec2::Y * 60.0)];
        assert_eq!(handle_at(Vec2::new(150.0, 104.0), &ends, 8.0), Some(Axis3::X));
        assert_eq!(handle_at(Vec2::new(97.0, 60.0), &ends, 8.0), Some(Axis3::Y));
        assert_eq!(handle_at(Vec2::new(130.0, 130.0), &ends, 8.0), None);
        assert_eq!(handle_at(middle, &[], 8.0), None);
    }

    #[test]
    fn a_ray_gives_the_place_on_an_axis() {
        let point = Vec3::new(1.0, 2.0, 3.0);
        for axis in Axis3::ALL {
            let eye = Vec3::new(4.0, 5.0, 6.0);
            let target = point + 0.7 * axis.vector();
            let ray = (eye, (target - eye).normalize_or_zero());
            let found = along(point, axis, ray).unwrap();
            assert!((found - 0.7).abs() < 1e-5, "{axis:?}: {found}");
            assert_eq!(along(point, axis, (eye, axis.vector())), None);
        }
    }

    #[test]
    fn a_ray_gives_the_angle_about_an_axis() {
        let point = Vec3::new(1.0, 2.0, 3.0);
        for (axis, first) in [(Axis3::X, Vec3::Y), (Axis3::Y, Vec3::Z), (Axis3::Z, Vec3::X)] {
            for turned in [-2.0_f32, 0.3, 3.0] {
                let target = point + glam::Quat::from_axis_angle(axis.vector(), turned) * (0.4 * first);
                let eye = Vec3::new(5.0, 6.0, 8.0);
                let ray = (eye, (target - eye).normalize_or_zero());
                let found = angle(point, axis, ray).unwrap();
                assert!((found - turned).abs() < 1e-4, "{axis:?}: {found}, not {turned}");
                assert_eq!(angle(point, axis, (eye, -ray.1)), None);
            }
            assert_eq!(angle(point, axis, (Vec3::ZERO, first)), None);
        }
    }
}
