//! Warnings about objects that are in each other's way at the start: dynamic bodies in other bodies, gauges in bodies, and
//! outlets close to a wall.

use glam::Vec3;

use super::motion::AXES;
use super::placed::Placed;
use crate::scene::{Emitter, Motion, Quantity, Scene, Section};

/// Bodies may overlap by this many spacings: the rounding of places.
const OVERLAP: f32 = 0.05;
/// Most points of a body that are tested against another one.
const MOST_POINTS: usize = 400;
/// An outlet this many spacings in front of a wall is blocked by it.
const ROOM: f32 = 2.0;
/// A smaller part of an outlet's direction towards a wall is along it.
const ALONG_WALL: f32 = 0.2;

/// Warns of dynamic bodies that overlap another body at the start. The contacts push them apart. A hinged body may contain
/// its axle.
pub(super) fn warn_of_overlaps(scene: &Scene, bodies: &[Placed<'_>], sections: &[Section<'_>]) {
    let slack = OVERLAP * scene.fluid.particle_spacing;
    for (index, (placed, section)) in bodies.iter().zip(sections).enumerate() {
        let Motion::Dynamic { hinge, .. } = &placed.body.motion else { continue };
        for (other, obstacle) in bodies.iter().enumerate() {
            let is_dynamic = matches!(obstacle.body.motion, Motion::Dynamic { .. });
            // Each pair of dynamic bodies once.
            let is_new = if is_dynamic { other < index } else { hinge.is_none() };
            if is_new && overlap(placed, obstacle, slack) {
                let message = format!(
                    "body {:?} overlaps body {:?} at the start",
                    placed.body.name, obstacle.body.name
                );
                section.warn("position", message, "contacts push them apart: move one of them");
            }
        }
    }
}

/// Whether two solids overlap by more than `slack` (m). Found if a point of the surface of one lies in the other: bars that
/// cross between those points are not.
fn overlap(a: &Placed<'_>, b: &Placed<'_>, slack: f32) -> bool {
    let (low, high) = (a.low.max(b.low), a.high.min(b.high));
    if (high - low).cmple(Vec3::splat(slack)).any() {
        return false;
    }
    [(a, b), (b, a)].into_iter().any(|(inner, outer)| {
        let points = inner.points_in(low, high, slack);
        let every = points.len().div_ceil(MOST_POINTS).max(1);
        points.into_iter().step_by(every).any(|point| outer.contains(point))
    })
}

/// Warns of gauges so deep in a body that no fluid is in their reach. One at its surface is common.
pub(super) fn warn_of_gauges(scene: &Scene, bodies: &[Placed<'_>], sections: &[Section<'_>]) {
    let reach = scene.solver.support_ratio * scene.fluid.particle_spacing;
    for (probe, section) in scene.probes.iter().zip(sections) {
        let Quantity::Pressure(place) = probe.quantity else { continue };
        let around = [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|axis| [-axis, axis]);
        let places: Vec<Vec3> = [place].into_iter().chain(around.map(|side| place + reach * side)).collect();
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

/// Warns of an outlet that points at a wall right in front of it. `points` are those of the outlet, in m.
pub(super) fn warn_of_walls(scene: &Scene, emitter: &Emitter, points: &[Vec3], section: &Section<'_>) {
    let domain = &scene.domain;
    let least = ROOM * scene.fluid.particle_spacing;
    for axis in 0..3 {
        let along = emitter.direction[axis];
        let side = usize::from(along > 0.0);
        if along.abs() < ALONG_WALL || !domain.closed[axis][side] {
            continue;
        }
        let wall = [domain.min, domain.max][side][axis];
        let room = points.iter().map(|x| (wall - x[axis]) / along).fold(f32::INFINITY, f32::min);
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
