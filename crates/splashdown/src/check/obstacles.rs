//! Warnings about objects that are in each other's way at the start: dynamic bodies in other bodies, gauges in bodies, and
//! outlets close to a wall.

use glam::Vec3;

use super::placed::Placed;
use crate::scene::{Emitter, Motion, Quantity, Scene, Section};

/// Bodies may overlap by this many spacings: the rounding of places.
const OVERLAP: f32 = 0.05;
/// Most points of a body that are tested against another one, and most pairs of a point and a triangle.
const MOST_POINTS: usize = 400;
const MOST_PAIRS: usize = 20_000_000;
/// An outlet this many spacings in front of a wall is blocked by it.
const ROOM: f32 = 2.0;

const AXES: [&str; 3] = ["x", "y", "z"];

/// Warns of dynamic bodies that overlap another body at the start. The contacts push them apart.
pub(super) fn warn_of_overlaps(scene: &Scene, bodies: &[Placed<'_>], sections: &[Section<'_>]) {
    let slack = OVERLAP * scene.fluid.particle_spacing;
    let is_dynamic = |placed: &Placed<'_>| matches!(placed.body.motion, Motion::Dynamic { .. });
    for (index, (placed, section)) in bodies.iter().zip(sections).enumerate() {
        // Each pair once, reported at a dynamic body.
        let others =
            bodies.iter().enumerate().filter(|(other, placed)| *other < index || !is_dynamic(placed));
        for (other, obstacle) in others {
            if is_dynamic(placed) && other != index && overlap(placed, obstacle, slack) {
                let message = format!(
                    "body {:?} overlaps body {:?} at the start",
                    placed.body.name, obstacle.body.name
                );
                section.warn("position", message, "contacts push them apart: move one of them");
            }
        }
    }
}

/// Whether two bodies overlap by more than `slack` (m). Found if a corner or the middle of a triangle of one lies in the
/// other, which only crossing bars avoid.
fn overlap(a: &Placed<'_>, b: &Placed<'_>, slack: f32) -> bool {
    let apart = |low: Vec3, high: Vec3| low.cmpge(high - slack).any();
    if apart(a.low, b.high) || apart(b.low, a.high) {
        return false;
    }
    [(a, b), (b, a)].into_iter().any(|(inner, outer)| {
        let most = MOST_POINTS.min(MOST_PAIRS / outer.triangle_count().max(1));
        inner.points(slack, most).any(|point| outer.contains(point))
    })
}

/// Warns of gauges deeper than a spacing in a body, where they measure nothing. One at its surface is common.
pub(super) fn warn_of_gauges(scene: &Scene, bodies: &[Placed<'_>], sections: &[Section<'_>]) {
    let spacing = scene.fluid.particle_spacing;
    for (probe, section) in scene.probes.iter().zip(sections) {
        let Quantity::Pressure(place) = probe.quantity else { continue };
        let around = [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|axis| [-axis, axis]);
        let places: Vec<Vec3> = around.map(|side| place + spacing * side).chain([place]).collect();
        for placed in bodies {
            if !places.iter().all(|x| placed.contains(*x)) {
                continue;
            }
            let until = if placed.body.motion == Motion::Static { "" } else { " until the body moves away" };
            let message = format!(
                "probe {:?} lies in body {:?}, where it measures a pressure of 0{until}",
                probe.name, placed.body.name
            );
            section.warn("position", message, "move it to the surface of the body, or into the fluid");
        }
    }
}

/// Warns of an outlet that points at a wall right in front of it.
pub(super) fn warn_of_walls(scene: &Scene, emitter: &Emitter, section: &Section<'_>) {
    let domain = &scene.domain;
    let least = ROOM * scene.fluid.particle_spacing;
    for axis in 0..3 {
        let along = emitter.direction[axis];
        let side = usize::from(along > 0.0);
        if along == 0.0 || !domain.closed[axis][side] {
            continue;
        }
        let wall = [domain.min, domain.max][side][axis];
        let room = (wall - emitter.position[axis]) / along;
        if room < least {
            let message = format!(
                "the outlet of emitter {:?} points at the wall {}_{}, {:.3} m in front of it: its fluid hardly gets out",
                emitter.name,
                AXES[axis],
                ["min", "max"][side],
                room.max(0.0)
            );
            let hint = format!("leave at least two spacings, {least:.3} m, or turn it");
            section.warn("position", message, &hint);
        }
    }
}
