//! The picture in the middle, and the mouse tools.

use egui::{Color32, PointerButton, Rect, Response, Sense, Stroke, TextureId, Ui};
use glam::{Quat, Vec2, Vec3};

use super::edit;
use crate::mouse;
use crate::state::{Action, Shaking, State, Tool};

/// Degrees of tilt per point.
const TILT: f32 = 0.25;
/// Rate at which a shaken tank follows the mouse, in 1/s.
const SHAKE_RATE: f32 = 12.0;

/// The position and size of the picture.
#[derive(Clone, Copy, Debug)]
pub struct Viewport {
    /// The rectangle in points.
    pub rect: Rect,
    /// The size in pixels.
    pub size: [u32; 2],
    /// Where a drag with the tool [`Tool::Drag`] started in this frame, in points of the picture.
    pub touched: Option<Vec2>,
}

pub(super) fn show(
    ui: &mut Ui,
    state: &mut State,
    picture: Option<TextureId>,
    actions: &mut Vec<Action>,
) -> Viewport {
    let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
    if let Some(picture) = picture {
        let whole = Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
        ui.painter().image(picture, rect, whole, Color32::WHITE);
    }
    zoom(ui, &response, state);
    let drag = response.drag_delta();
    let drag = Vec2::new(drag.x, drag.y);
    let by = |button| response.dragged_by(button);
    if by(PointerButton::Secondary) || by(PointerButton::Middle) {
        state.orbit.pan(drag, size_of(rect));
    }
    let tool = match (&state.timeline, ui.input(|input| input.modifiers.shift)) {
        // The fluid of a finished run cannot be moved.
        (Some(_), _) => Tool::Orbit,
        (None, true) if state.moving.is_none() => Tool::Drag,
        (None, _) => state.tool,
    };
    let mut touched = None;
    match tool {
        Tool::Orbit if by(PointerButton::Primary) => state.orbit.orbit(drag),
        Tool::Drag => touched = drag_fluid(ui, &response, state, actions),
        Tool::Tilt => tilt(&response, drag, state, actions),
        Tool::Shake if by(PointerButton::Primary) => {
            let [right, up, _] = state.orbit.axes();
            let motion = state.orbit.metres_per_point(size_of(rect)) * (drag.x * right - drag.y * up);
            let gravity = state.scene.gravity;
            state.shaking.get_or_insert(Shaking { gravity, ..Shaking::default() }).target += motion;
        }
        Tool::Shake => {}
        Tool::Edit => edit::interact(ui, &response, state, actions),
        Tool::Orbit => {}
    }
    if tool == Tool::Drag && state.grip.is_none() {
        ring(ui, &response, state);
    }
    if tool != Tool::Drag && state.drag_point.take().is_some() {
        state.grip = None;
        actions.push(Action::Release);
    }
    let held = tool == Tool::Shake && by(PointerButton::Primary);
    shake(ui, held, state, actions);
    let scale = ui.ctx().pixels_per_point();
    let size = [rect.width(), rect.height()].map(|side| (side * scale).round().max(1.0) as u32);
    Viewport { rect, size, touched }
}

fn size_of(rect: Rect) -> Vec2 {
    Vec2::new(rect.width(), rect.height())
}

fn zoom(ui: &Ui, response: &Response, state: &mut State) {
    if !response.hovered() {
        return;
    }
    let (scroll, pinch) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
    state.orbit.zoom((0.002 * scroll).exp() * pinch);
    if let Some(touch) = ui.input(egui::InputState::multi_touch) {
        let slide = touch.translation_delta;
        state.orbit.pan(Vec2::new(slide.x, slide.y), size_of(response.rect));
    }
}

/// Drags the fluid or a body. The mouse force acts in the plane through the camera's target. A held body keeps its distance
/// from the camera.
fn drag_fluid(ui: &Ui, response: &Response, state: &mut State, actions: &mut Vec<Action>) -> Option<Vec2> {
    let size = size_of(response.rect);
    let place = response.interact_pointer_pos().map(|at| at - response.rect.min);
    let Some(at) = place.filter(|_| response.dragged_by(PointerButton::Primary)) else {
        if state.drag_point.take().is_some() {
            state.grip = None;
            actions.push(Action::Release);
        }
        return None;
    };
    let at = Vec2::new(at.x, at.y);
    let ray = state.orbit.ray(at, size);
    let Some(before) = state.drag_point.replace(at) else { return Some(at) };
    if let Some((mut grip, distance)) = state.grip {
        grip.target = ray.0 + distance * ray.1;
        state.grip = Some((grip, distance));
        actions.push(Action::Grip(grip));
        return None;
    }
    let seconds = ui.input(|input| input.stable_dt).clamp(1e-3, 0.1);
    let old = state.orbit.ray(before, size);
    let depth = state.orbit.distance;
    let velocity = (ray.0 + depth * ray.1 - old.0 - depth * old.1) / seconds;
    actions.push(Action::Drag { ray, velocity });
    None
}

/// Shows the reach of the mouse force, at the distance of the camera's target.
fn ring(ui: &Ui, response: &Response, state: &State) {
    let Some(at) = response.hover_pos().or(response.interact_pointer_pos()) else { return };
    let radius = mouse::radius(&state.scene) / state.orbit.metres_per_point(size_of(response.rect));
    let painter = ui.painter_at(response.rect);
    // Two colours, so that it is visible on the fluid and on the sky.
    painter.circle_stroke(at, radius, Stroke::new(3.0, Color32::from_black_alpha(110)));
    painter.circle_stroke(at, radius, Stroke::new(1.5, Color32::WHITE));
}

/// Rotates gravity, which is equivalent to tilting the tank.
fn tilt(response: &Response, drag: Vec2, state: &mut State, actions: &mut Vec<Action>) {
    if response.double_clicked() {
        state.scene.gravity = state.upright;
        actions.push(Action::Change);
    } else if response.dragged_by(PointerButton::Primary) && drag != Vec2::ZERO {
        let [_, _, forward] = state.orbit.axes();
        let ahead = Vec3::new(forward.x, 0.0, forward.z).normalize_or(Vec3::NEG_Z);
        let aside = ahead.cross(Vec3::Y);
        // The tank tilts towards the drag: gravity in the frame of the tank rotates the other way.
        let turn = Quat::from_axis_angle(ahead, -(TILT * drag.x).to_radians())
            * Quat::from_axis_angle(aside, -(TILT * drag.y).to_radians());
        state.scene.gravity = turn * state.scene.gravity;
        actions.push(Action::Change);
    }
}

/// Moves the shaken tank. A critically damped spring pulls it towards the mouse, and its acceleration acts on the fluid.
/// When released, the tank returns to its original position.
fn shake(ui: &Ui, held: bool, state: &mut State, actions: &mut Vec<Action>) {
    let Some(shaking) = &mut state.shaking else { return };
    if !held {
        shaking.target = Vec3::ZERO;
    }
    let seconds = ui.input(|input| input.stable_dt).clamp(1e-3, 0.05);
    let acceleration =
        SHAKE_RATE * SHAKE_RATE * (shaking.target - shaking.offset) - 2.0 * SHAKE_RATE * shaking.velocity;
    shaking.velocity += seconds * acceleration;
    shaking.offset += seconds * shaking.velocity;
    state.scene.gravity = shaking.gravity - acceleration;
    if !held && shaking.offset.length() < 1e-3 * state.orbit.distance && acceleration.length() < 0.1 {
        state.scene.gravity = shaking.gravity;
        state.shaking = None;
    }
    ui.ctx().request_repaint();
    actions.push(Action::Change);
}
