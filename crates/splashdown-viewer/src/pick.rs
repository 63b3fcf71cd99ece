//! Ray picking.

use glam::Vec3;
use splashdown::BodyState;
use splashdown::scene::Motion;

use crate::engine::{Grip, Opened};

/// The dynamic body that a ray (a point in m and a unit vector) hits before any other body, held at the point of the hit,
/// and the distance of that point from the start of the ray in m.
pub fn body(opened: &Opened, states: &[BodyState], (origin, direction): (Vec3, Vec3)) -> Option<(Grip, f32)> {
    let mut nearest: Option<(usize, f32)> = None;
    for (number, (body, state)) in opened.bodies.iter().zip(states).enumerate() {
        let back = state.orientation.conjugate();
        let (from, along) = (back * (origin - state.position), back * direction);
        for triangle in &body.mesh.triangles {
            let corners = triangle.map(|v| Vec3::from(body.mesh.vertices[v as usize]));
            if let Some(distance) = hit(from, along, corners)
                && nearest.is_none_or(|(_, least)| distance < least)
            {
                nearest = Some((number, distance));
            }
        }
    }
    let (number, distance) = nearest?;
    let dynamic = matches!(opened.scene.bodies.get(number)?.motion, Motion::Dynamic { .. });
    let (state, target) = (states.get(number)?, origin + distance * direction);
    let anchor = state.orientation.conjugate() * (target - state.position);
    dynamic.then_some((Grip { body: number, anchor, target }, distance))
}

/// The distance at which a ray hits a triangle, if it does (Moeller and Trumbore 1997).
fn hit(origin: Vec3, direction: Vec3, [a, b, c]: [Vec3; 3]) -> Option<f32> {
    let (along, across) = (b - a, c - a);
    let p = direction.cross(across);
    let determinant = along.dot(p);
    if determinant.abs() < f32::MIN_POSITIVE {
        return None;
    }
    let from = origin - a;
    let u = from.dot(p) / determinant;
    let q = from.cross(along);
    let v = direction.dot(q) / determinant;
    let distance = across.dot(q) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0).then_some(distance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_is_hit_inside_and_missed_outside() {
        let corners = [Vec3::new(0.0, 0.0, 1.0), Vec3::new(1.0, 0.0, 1.0), Vec3::new(0.0, 1.0, 1.0)];
        let at = |x: f32, y: f32| hit(Vec3::new(x, y, -1.0), Vec3::Z, corners);
        assert_eq!(at(0.2, 0.3), Some(2.0));
        assert_eq!(at(0.6, 0.6), None);
        assert_eq!(hit(Vec3::new(0.2, 0.3, 2.0), Vec3::Z, corners), None);
    }
}
