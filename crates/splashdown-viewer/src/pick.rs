//! Ray picking.

use glam::Vec3;
use splashdown::BodyState;
use splashdown::scene::Motion;
use splashdown::solid::ray_distance;

use crate::engine::{Grip, Opened};
use crate::items::BodyBounds;

/// The bounding boxes of the bodies in these states, relative to the positions of their meshes in the scene.
pub fn bounds(opened: &Opened, states: &[BodyState]) -> BodyBounds {
    let bodies = opened.bodies.iter().zip(states).zip(&opened.scene.bodies);
    bodies
        .map(|((body, state), source)| {
            let place = |&vertex: &[f32; 3]| {
                state.position + state.orientation * Vec3::from(vertex) - source.mesh.position
            };
            let points = body.mesh.vertices.iter().map(place);
            let low = points.clone().fold(Vec3::INFINITY, Vec3::min);
            (body.name.clone(), (low, points.fold(Vec3::NEG_INFINITY, Vec3::max)))
        })
        .collect()
}

/// The dynamic body that a ray (a point in m and a unit vector) hits before any other body, held at the point of the hit,
/// and the distance of that point from the start of the ray in m.
pub fn body(opened: &Opened, states: &[BodyState], (origin, direction): (Vec3, Vec3)) -> Option<(Grip, f32)> {
    let mut nearest: Option<(usize, f32)> = None;
    for (number, (body, state)) in opened.bodies.iter().zip(states).enumerate() {
        let back = state.orientation.conjugate();
        let (from, along) = (back * (origin - state.position), back * direction);
        for triangle in &body.mesh.triangles {
            let corners = triangle.map(|v| Vec3::from(body.mesh.vertices[v as usize]));
            if let Some(distance) = ray_distance(from, along, &corners)
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
