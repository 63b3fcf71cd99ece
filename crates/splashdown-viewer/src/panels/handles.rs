//! The handles of the tool Edit: where they are in the picture, which one is grabbed, and how they are drawn.

use egui::{Color32, Painter, Pos2, Rect, Shape as Drawing, Stroke};
use glam::{Quat, Vec2, Vec3};
use splashdown::scene::Scene;

use crate::items::{self, Axis3, Grab, Item};
use crate::state::{Moving, State};

/// Length of an arrow, in points.
const ARROW: f32 = 70.0;
/// Radius of a ring, in points.
const RING: f32 = 92.0;
/// Length of the arrow that shows the direction of an emitter, in points.
const STREAM: f32 = 45.0;
/// Number of lines in a ring.
const SEGMENTS: u8 = 48;
/// Half the edge of the square on a face, in points.
const FACE: f32 = 4.0;
/// A face whose point is nearer to the middle of its block than this has no handle, because the arrows are there.
const FACE_GAP: f32 = 16.0;
/// A handle is grabbed within this many points.
const REACH: f32 = 9.0;

/// The middle of a thing.
pub(super) fn middle(item: Item, state: &State) -> Option<Vec3> {
    let (low, high) = item.bounds(&state.scene, &state.body_bounds)?;
    Some(0.5 * (low + high))
}

/// The handle at a place in points of the picture. The points on the faces come first, because they are small.
pub(super) fn grab_at(at: Vec2, state: &State, rect: Rect) -> Option<Grab> {
    let distance =
        |(axis, is_upper, place): (Axis3, bool, Vec2)| (Grab::Face(axis, is_upper), place.distance(at));
    let nearest = |handles: Vec<(Grab, f32)>| {
        let nearest = handles.into_iter().min_by(|(_, a), (_, b)| a.total_cmp(b))?;
        (nearest.1 <= REACH).then_some(nearest.0)
    };
    let face = nearest(faces(state, rect).into_iter().map(distance).collect());
    let arrow = || items::handle_at(at, &arrows(state, rect), REACH).map(Grab::Move);
    let ring = || {
        let distance = |(axis, line): (Axis3, Vec<Vec2>)| {
            let parts = line.windows(2).map(|pair| items::line_distance(at, pair[0], pair[1]));
            (Grab::Turn(axis), parts.fold(f32::INFINITY, f32::min))
        };
        nearest(rings(state, rect).into_iter().map(distance).collect())
    };
    face.or_else(arrow).or_else(ring)
}

/// Where a handle is held by a ray: an offset along its axis in m, or an angle about it in radians.
pub(super) fn held(grab: Grab, middle: Vec3, ray: (Vec3, Vec3)) -> Option<f32> {
    match grab {
        Grab::Move(axis) | Grab::Face(axis, _) => items::along(middle, axis, ray),
        Grab::Turn(axis) => items::angle(middle, axis, ray),
    }
}

/// Moves, resizes or turns the thing of the scene before by what its handle was dragged.
pub(super) fn drag(moving: &mut Moving, to: f32, state: &mut State) {
    let (item, by) = (moving.item, to - moving.from);
    let mut scene = moving.before.clone();
    match moving.grab {
        Grab::Move(axis) => {
            let offset = inside(item, &moving.before, state, axis.vector() * by);
            item.move_by(&mut scene, offset);
        }
        Grab::Face(axis, is_upper) => item.resize(&mut scene, axis, is_upper, by),
        Grab::Turn(axis) => {
            moving.turned = Quat::from_axis_angle(axis.vector(), by);
            item.rotate_by(&mut scene, moving.turned, moving.middle);
        }
    }
    state.scene = scene;
}

/// The offset, limited so that the thing stays inside the domain.
fn inside(item: Item, before: &Scene, state: &State, offset: Vec3) -> Vec3 {
    let Some((low, high)) = item.bounds(before, &state.body_bounds) else { return offset };
    let domain = &before.domain;
    // What reaches out of the domain already can stay where it is.
    offset.clamp((domain.min - low).min(Vec3::ZERO), (domain.max - high).max(Vec3::ZERO))
}

/// A point of the scene in points of the picture.
fn projected(state: &State, rect: Rect, point: Vec3) -> Option<Vec2> {
    let camera = state.orbit.camera(rect.width() / rect.height().max(1.0));
    // In units of a sixteenth of a point, because the size is in whole numbers.
    let size = [rect.width(), rect.height()].map(|side| (16.0 * side).round().max(1.0) as u32);
    let [x, y] = camera.project(point.into(), size).ok().flatten()?;
    Some(Vec2::new(x, y) / 16.0)
}

/// The selected thing that can be changed by handles, its middle, and the metres per point there.
fn handled(state: &State, rect: Rect) -> Option<(Item, Vec3, f32)> {
    let item = state.selected.filter(|item| item.is_movable(&state.scene))?;
    // While it turns, the box of the mesh is that before.
    let turning = state.moving.as_ref().filter(|moving| matches!(moving.grab, Grab::Turn(_)));
    let middle = turning.map(|moving| moving.middle).or_else(|| middle(item, state))?;
    Some((item, middle, state.orbit.metres_per_point(Vec2::new(rect.width(), rect.height()))))
}

/// The arrows: axes and ends in points of the picture.
fn arrows(state: &State, rect: Rect) -> Vec<(Axis3, Vec2, Vec2)> {
    let Some((_, middle, scale)) = handled(state, rect) else { return Vec::new() };
    let ends = |axis: Axis3| {
        let from = projected(state, rect, middle)?;
        Some((axis, from, projected(state, rect, middle + ARROW * scale * axis.vector())?))
    };
    Axis3::ALL.into_iter().filter_map(ends).collect()
}

/// The points on the faces of a block: axis, whether it is the face of the higher coordinate, and place.
fn faces(state: &State, rect: Rect) -> Vec<(Axis3, bool, Vec2)> {
    let Some((Item::Block(index), middle, _)) = handled(state, rect) else { return Vec::new() };
    let (low, high) = state.scene.fluid.blocks[index].shape.bounds();
    let Some(center) = projected(state, rect, middle) else { return Vec::new() };
    let place = |(axis, is_upper): (Axis3, bool)| {
        let mut point = middle;
        point[axis as usize] = if is_upper { high } else { low }[axis as usize];
        let place = projected(state, rect, point)?;
        (place.distance(center) >= FACE_GAP).then_some((axis, is_upper, place))
    };
    let sides = Axis3::ALL.into_iter().flat_map(|axis| [(axis, true), (axis, false)]);
    sides.filter_map(place).collect()
}

/// The rings around what can be rotated: axes, and closed lines in points of the picture.
fn rings(state: &State, rect: Rect) -> Vec<(Axis3, Vec<Vec2>)> {
    let Some((item, middle, scale)) = handled(state, rect) else { return Vec::new() };
    if !item.is_rotatable(&state.scene) {
        return Vec::new();
    }
    let ring = |axis: Axis3| {
        let radius = RING * scale * axis.vector().any_orthonormal_vector();
        let point = |step: u8| {
            let angle = std::f32::consts::TAU * f32::from(step) / f32::from(SEGMENTS);
            projected(state, rect, middle + Quat::from_axis_angle(axis.vector(), angle) * radius)
        };
        Some((axis, (0..=SEGMENTS).map(point).collect::<Option<Vec<_>>>()?))
    };
    Axis3::ALL.into_iter().filter_map(ring).collect()
}

fn colour(axis: Axis3) -> Color32 {
    match axis {
        Axis3::X => Color32::from_rgb(220, 60, 50),
        Axis3::Y => Color32::from_rgb(60, 170, 60),
        Axis3::Z => Color32::from_rgb(60, 110, 230),
    }
}

/// Draws the boxes of all things, the directions of emitters, and the handles of the selected one.
pub(super) fn draw(painter: &Painter, rect: Rect, state: &State) {
    let at = |point: Vec2| rect.min + egui::vec2(point.x, point.y);
    for item in Item::all(&state.scene) {
        let stroke = match state.selected == Some(item) {
            true => Stroke::new(2.0, Color32::from_rgb(255, 170, 40)),
            false => Stroke::new(1.0, Color32::from_rgba_unmultiplied(40, 60, 80, 160)),
        };
        let Some(corners) = corners(item, state) else { continue };
        let corners = corners.map(|corner| projected(state, rect, corner));
        for (from, to) in (0..8).flat_map(|i| [1, 2, 4].map(|bit| (i, i | bit))).filter(|(i, j)| i != j) {
            if let (Some(from), Some(to)) = (corners[from], corners[to]) {
                painter.line_segment([at(from), at(to)], stroke);
            }
        }
    }
    for emitter in &state.scene.emitters {
        let length = STREAM * state.orbit.metres_per_point(Vec2::new(rect.width(), rect.height()));
        let ends = [emitter.position, emitter.position + length * emitter.direction];
        if let [Some(from), Some(to)] = ends.map(|point| projected(state, rect, point)) {
            painter.arrow(at(from), at(to) - at(from), Stroke::new(2.0, Color32::from_rgb(40, 150, 200)));
        }
    }
    let held = state.moving.as_ref().map(|moving| moving.grab);
    let stroke = |grab: Grab, usual: f32| {
        Stroke::new(if held == Some(grab) { usual + 2.0 } else { usual }, colour(grab.axis()))
    };
    for (axis, line) in rings(state, rect) {
        let line: Vec<Pos2> = line.into_iter().map(at).collect();
        painter.add(Drawing::line(line, stroke(Grab::Turn(axis), 1.5)));
    }
    for (axis, from, to) in arrows(state, rect) {
        painter.arrow(at(from), at(to) - at(from), stroke(Grab::Move(axis), 3.0));
    }
    for (axis, is_upper, place) in faces(state, rect) {
        let size = if held == Some(Grab::Face(axis, is_upper)) { FACE + 2.0 } else { FACE };
        let square = Rect::from_center_size(at(place), egui::Vec2::splat(2.0 * size));
        painter.rect_filled(square, 1.0, colour(axis));
        let border = Stroke::new(1.0, Color32::WHITE);
        painter.rect_stroke(square, 1.0, border, egui::StrokeKind::Outside);
    }
}

/// The corners of the box of a thing; that of a mesh turns with it.
fn corners(item: Item, state: &State) -> Option<[Vec3; 8]> {
    let turning = state.moving.as_ref().filter(|moving| moving.item == item);
    let turning = turning.filter(|moving| matches!(moving.grab, Grab::Turn(_)));
    let scene = turning.map_or(&state.scene, |moving| &moving.before);
    let (low, high) = item.bounds(scene, &state.body_bounds)?;
    let corner = |i: usize| {
        let choose = |axis: usize| if i >> axis & 1 == 0 { low[axis] } else { high[axis] };
        let corner = Vec3::from_array(std::array::from_fn(choose));
        turning.map_or(corner, |moving| moving.middle + moving.turned * (corner - moving.middle))
    };
    Some(std::array::from_fn(corner))
}
