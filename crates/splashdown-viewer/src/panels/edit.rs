//! The tool Edit: selecting, moving, adding and removing blocks, bodies and emitters of the scene at time 0.

use egui::{
    Color32, Context, Key, Modifiers, Painter, PointerButton, Pos2, Rect, Response, ScrollArea, Stroke, Ui,
};
use glam::{Vec2, Vec3};
use splashdown::scene::Scene;

use super::{dialog, icons};
use crate::items::{self, Axis3, Item};
use crate::state::{Action, Moving, State, Tool};
use crate::{edit, save};

/// Length of a handle, in points.
const HANDLE: f32 = 70.0;
/// Height of the buttons below the list, in points.
const BUTTONS: f32 = 110.0;
/// A handle is grabbed within this many points.
const REACH: f32 = 9.0;

/// The mouse in the picture.
pub(super) fn interact(ui: &Ui, response: &Response, state: &mut State, actions: &mut Vec<Action>) {
    let rect = response.rect;
    let size = Vec2::new(rect.width(), rect.height());
    let local = |at: Pos2| Vec2::new(at.x - rect.left(), at.y - rect.top());
    state.selected = state.selected.filter(|item| item.is_in(&state.scene));
    let pressed = ui.input(|input| input.pointer.press_origin());
    if response.drag_started_by(PointerButton::Primary)
        && let (Some(item), Some(at)) = (state.selected, pressed)
        && let Some(middle) = middle(item, state)
        && let Some(axis) = items::handle_at(local(at), &handles(state, rect), REACH)
        && let Some(from) = items::along(middle, axis, state.orbit.ray(local(at), size))
    {
        state.moving = Some(Moving { item, axis, middle, from, before: state.scene.clone() });
    }
    match (state.moving.take(), response.dragged_by(PointerButton::Primary)) {
        (Some(moving), true) => {
            let to = response
                .interact_pointer_pos()
                .and_then(|at| items::along(moving.middle, moving.axis, state.orbit.ray(local(at), size)));
            if let Some(to) = to {
                let offset = moving.axis.vector() * (to - moving.from);
                let offset = inside(moving.item, &moving.before, state, offset);
                state.scene.clone_from(&moving.before);
                moving.item.move_by(&mut state.scene, offset);
            }
            state.moving = Some(moving);
        }
        (Some(moving), false) => finish(state, moving.before, actions, ui.ctx()),
        (None, true) => {
            let drag = response.drag_delta();
            state.orbit.orbit(Vec2::new(drag.x, drag.y));
        }
        (None, false) => {}
    }
    if let Some(at) = response.interact_pointer_pos().filter(|_| response.clicked()) {
        state.selected = items::hit(&state.scene, &state.body_bounds, state.orbit.ray(local(at), size));
    }
    draw(&ui.painter_at(rect), rect, state);
}

/// The list of things, and the buttons.
pub(super) fn show(ctx: &Context, state: &mut State, actions: &mut Vec<Action>, over: Rect) {
    if state.tool != Tool::Edit || state.timeline.is_some() {
        return;
    }
    keys(ctx, state, actions);
    let mut is_open = true;
    dialog::new("Edit", over).open(&mut is_open).resizable(false).default_width(150.0).show(ctx, |ui| {
        let height = (dialog::inner_height(over) - BUTTONS).max(60.0);
        ScrollArea::vertical().max_height(height).show(ui, |ui| {
            for item in Item::all(&state.scene) {
                let name = item.name(&state.scene);
                if ui.selectable_label(state.selected == Some(item), name).clicked() {
                    state.selected = Some(item);
                }
            }
        });
        ui.separator();
        let before = state.scene.clone();
        ui.horizontal(|ui| {
            if ui.button("Add block").on_hover_text("A block of fluid").clicked() {
                state.selected = Some(items::add_block(&mut state.scene));
            }
            if ui.button("Add ball").on_hover_text("A floating ball").clicked() {
                edit::add_ball(&mut state.scene);
                state.selected = Some(Item::Body(state.scene.bodies.len() - 1));
            }
            let can_add = !edit::has_tap(&state.scene);
            let tap = ui.add_enabled(can_add, egui::Button::new("Add tap"));
            if tap.on_hover_text("An emitter that points down").clicked() {
                edit::turn_tap(&mut state.scene);
                state.selected = Some(Item::Emitter(state.scene.emitters.len() - 1));
            }
        });
        finish(state, before, actions, ui.ctx());
        ui.horizontal(|ui| {
            let (can_undo, can_redo) = state.history.can_undo_and_redo();
            let is_selected = state.selected.is_some();
            let mut button = |enabled: bool, icon: &str, name: &str, hint: &str| {
                ui.add_enabled_ui(enabled, |ui| icons::button(ui, icon, name, hint).clicked()).inner
            };
            if button(is_selected, icons::REMOVE, "Remove", "The selected thing (Delete)") {
                remove(state, actions, ctx);
            }
            if button(can_undo, icons::UNDO, "Undo", "Ctrl + Z") {
                undo(state, actions);
            }
            if button(can_redo, icons::REDO, "Redo", "Ctrl + Shift + Z") {
                redo(state, actions);
            }
        });
        if state.selected.is_some_and(|item| !item.is_movable(&state.scene)) {
            ui.weak("A script moves this body.");
        }
    });
    if !is_open {
        state.tool = Tool::Orbit;
    }
}

fn keys(ctx: &Context, state: &mut State, actions: &mut Vec<Action>) {
    // A drag of a handle ends first.
    if ctx.egui_wants_keyboard_input() || state.moving.is_some() {
        return;
    }
    let pressed = |modifiers, key| ctx.input_mut(|input| input.consume_key(modifiers, key));
    if pressed(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z) || pressed(Modifiers::COMMAND, Key::Y) {
        redo(state, actions);
    }
    if pressed(Modifiers::COMMAND, Key::Z) {
        undo(state, actions);
    }
    if pressed(Modifiers::NONE, Key::Delete) {
        remove(state, actions, ctx);
    }
}

fn remove(state: &mut State, actions: &mut Vec<Action>, ctx: &Context) {
    let Some(item) = state.selected.take() else { return };
    let before = state.scene.clone();
    item.remove(&mut state.scene);
    finish(state, before, actions, ctx);
}

fn undo(state: &mut State, actions: &mut Vec<Action>) {
    if let Some(scene) = state.history.undo(&state.scene) {
        restore(state, scene);
        start_again(state, actions);
    }
}

fn redo(state: &mut State, actions: &mut Vec<Action>) {
    if let Some(scene) = state.history.redo(&state.scene) {
        restore(state, scene);
        start_again(state, actions);
    }
}

/// Takes back what this tool changes, and nothing else: the settings remain.
fn restore(state: &mut State, scene: Scene) {
    state.scene.fluid.blocks = scene.fluid.blocks;
    state.scene.bodies = scene.bodies;
    state.scene.emitters = scene.emitters;
    state.scene.duration = scene.duration;
}

/// Ends a change of the scene. One that a scene file could not contain, such as a block outside the domain, is taken
/// back with the reason.
fn finish(state: &mut State, before: Scene, actions: &mut Vec<Action>, ctx: &Context) {
    if state.scene == before {
        return;
    }
    match save::scene(&state.scene, &state.orbit) {
        Ok(_) => {
            state.history.record(before);
            start_again(state, actions);
        }
        Err(reason) => {
            state.scene = before;
            state.notify(reason, true, ctx.input(|input| input.time));
        }
    }
}

/// Shows the scene at time 0.
pub(super) fn start_again(state: &mut State, actions: &mut Vec<Action>) {
    state.playing = false;
    state.pouring = edit::has_tap(&state.scene);
    state.counted = splashdown::check::count(&state.scene);
    state.particles_wanted = state.counted as f32;
    actions.push(Action::Reset);
}

fn middle(item: Item, state: &State) -> Option<Vec3> {
    let (low, high) = item.bounds(&state.scene, &state.body_bounds)?;
    Some(0.5 * (low + high))
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

/// The handles of the selected thing: axes and their ends in points of the picture.
fn handles(state: &State, rect: Rect) -> Vec<(Axis3, Vec2, Vec2)> {
    let Some(item) = state.selected.filter(|item| item.is_movable(&state.scene)) else { return Vec::new() };
    let Some(middle) = middle(item, state) else { return Vec::new() };
    let length = HANDLE * state.orbit.metres_per_point(Vec2::new(rect.width(), rect.height()));
    let ends = |axis: Axis3| {
        let from = projected(state, rect, middle)?;
        Some((axis, from, projected(state, rect, middle + length * axis.vector())?))
    };
    Axis3::ALL.into_iter().filter_map(ends).collect()
}

fn draw(painter: &Painter, rect: Rect, state: &State) {
    let at = |point: Vec2| rect.min + egui::vec2(point.x, point.y);
    for item in Item::all(&state.scene) {
        let Some((low, high)) = item.bounds(&state.scene, &state.body_bounds) else { continue };
        let stroke = match state.selected == Some(item) {
            true => Stroke::new(2.0, Color32::from_rgb(255, 170, 40)),
            false => Stroke::new(1.0, Color32::from_rgba_unmultiplied(40, 60, 80, 160)),
        };
        let corner = |i: usize| {
            Vec3::from_array(std::array::from_fn(
                |axis| if i >> axis & 1 == 0 { low[axis] } else { high[axis] },
            ))
        };
        let corners: [_; 8] = std::array::from_fn(|i| projected(state, rect, corner(i)));
        for (from, to) in (0..8).flat_map(|i| [1, 2, 4].map(|bit| (i, i | bit))).filter(|(i, j)| i != j) {
            if let (Some(from), Some(to)) = (corners[from], corners[to]) {
                painter.line_segment([at(from), at(to)], stroke);
            }
        }
    }
    for (axis, from, to) in handles(state, rect) {
        let colour = match axis {
            Axis3::X => Color32::from_rgb(220, 60, 50),
            Axis3::Y => Color32::from_rgb(60, 170, 60),
            Axis3::Z => Color32::from_rgb(60, 110, 230),
        };
        let is_moved = state.moving.as_ref().is_some_and(|moving| moving.axis == axis);
        let width = if is_moved { 5.0 } else { 3.0 };
        painter.arrow(at(from), at(to) - at(from), Stroke::new(width, colour));
    }
}
