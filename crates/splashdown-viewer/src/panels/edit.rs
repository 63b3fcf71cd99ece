//! The tool Edit: selecting, moving, rotating, resizing, adding and removing blocks, meshes, bodies and emitters of the scene
//! at time 0.

use egui::{Context, Key, Modifiers, PointerButton, Pos2, Rect, Response, ScrollArea, Ui};
use glam::{Quat, Vec2};

use super::change::{finish, redo, start_again, undo};
use super::{add_mesh, dialog, fields, handles, icons};
use crate::edit;
use crate::items::{self, Item};
use crate::state::{Action, Moving, State, Tool};

/// Height of the fields and the buttons below the list, in points.
const BUTTONS: f32 = 260.0;

/// The mouse in the picture. Things are where they are drawn at time 0 only; later it orbits the camera.
pub(super) fn interact(ui: &Ui, response: &Response, state: &mut State, actions: &mut Vec<Action>) {
    let rect = response.rect;
    let size = Vec2::new(rect.width(), rect.height());
    let local = |at: Pos2| Vec2::new(at.x - rect.left(), at.y - rect.top());
    state.selected = state.selected.filter(|item| item.is_in(&state.scene));
    let pressed = ui.input(|input| input.pointer.press_origin());
    if !state.is_at_start() && state.moving.is_none() {
        if response.dragged_by(PointerButton::Primary) {
            orbit(response, state);
        }
        return;
    }
    if response.drag_started_by(PointerButton::Primary)
        && let (Some(item), Some(at)) = (state.selected, pressed)
        && let Some(middle) = handles::middle(item, state)
        && let Some(grab) = handles::grab_at(local(at), state, rect)
        && let Some(from) = handles::held(grab, middle, state.orbit.ray(local(at), size))
    {
        let before = state.scene.clone();
        state.moving = Some(Moving { item, grab, middle, from, turned: Quat::IDENTITY, before });
    }
    match (state.moving.take(), response.dragged_by(PointerButton::Primary)) {
        (Some(mut moving), true) => {
            let ray = response.interact_pointer_pos().map(|at| state.orbit.ray(local(at), size));
            if let Some(to) = ray.and_then(|ray| handles::held(moving.grab, moving.middle, ray)) {
                handles::drag(&mut moving, to, state);
            }
            state.moving = Some(moving);
        }
        (Some(moving), false) => finish(state, moving.before, actions, ui.input(|input| input.time)),
        (None, true) => orbit(response, state),
        (None, false) => {}
    }
    if let Some(at) = response.interact_pointer_pos().filter(|_| response.clicked()) {
        state.selected = items::hit(&state.scene, &state.body_bounds, state.orbit.ray(local(at), size));
    }
    handles::draw(&ui.painter_at(rect), rect, state);
}

fn orbit(response: &Response, state: &mut State) {
    let drag = response.drag_delta();
    state.orbit.orbit(Vec2::new(drag.x, drag.y));
}

/// The list of things, and the buttons.
pub(super) fn show(ctx: &Context, state: &mut State, actions: &mut Vec<Action>, over: Rect) {
    let now = ctx.input(|input| input.time);
    if state.tool != Tool::Edit || state.timeline.is_some() {
        if let Some(typing) = state.typing.take() {
            finish(state, typing.before, actions, now);
        }
        return;
    }
    keys(ctx, state, actions);
    let mut is_open = true;
    dialog::new("Edit", over).open(&mut is_open).resizable(false).default_width(150.0).show(ctx, |ui| {
        let height = dialog::inner_height(over);
        ScrollArea::vertical().max_height(height).show(ui, |ui| {
            if !state.is_at_start() {
                moved_on(ui, state, actions);
            }
            list(ui, state, (height - BUTTONS).max(60.0));
            ui.separator();
            if let Some(before) = fields::show(ui, state) {
                finish(state, before, actions, now);
            }
            add(ui, state, actions, now);
            history(ui, state, actions, now);
            if state.selected.is_some_and(|item| !item.is_movable(&state.scene)) {
                ui.weak("A script moves this body.");
            }
        });
    });
    if !is_open {
        state.tool = Tool::Orbit;
    }
}

/// The way back to time 0, where things are edited.
fn moved_on(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>) {
    ui.horizontal_wrapped(|ui| {
        ui.weak("Handles are shown at time 0.");
        if ui
            .button("Restart")
            .on_hover_text("Pause at time 0. Each change of a thing does the same")
            .clicked()
        {
            start_again(state, actions);
        }
    });
}

/// The things of the scene.
fn list(ui: &mut Ui, state: &mut State, height: f32) {
    ScrollArea::vertical().id_salt("things").max_height(height).show(ui, |ui| {
        for item in Item::all(&state.scene) {
            let name = item.name(&state.scene);
            if ui.selectable_label(state.selected == Some(item), name).clicked() {
                state.selected = Some(item);
            }
        }
    });
}

/// The buttons that add things.
fn add(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>, now: f64) {
    let before = state.scene.clone();
    ui.horizontal(|ui| {
        if ui.button("Add block").on_hover_text("A block of fluid").clicked() {
            state.selected = Some(items::add_block(&mut state.scene));
        }
        if ui.button("Add ball").on_hover_text("A floating ball (B)").clicked() {
            edit::add_ball(&mut state.scene);
            state.selected = Some(Item::Body(state.scene.bodies.len() - 1));
        }
        if ui.button("Add emitter").on_hover_text("A source of fluid that points down").clicked() {
            edit::add_emitter(&mut state.scene);
            state.selected = Some(Item::Emitter(state.scene.emitters.len() - 1));
        }
    });
    finish(state, before, actions, now);
    ui.horizontal(|ui| add_mesh(ui, actions));
}

/// Removing, undoing and redoing.
fn history(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>, now: f64) {
    ui.horizontal(|ui| {
        let (can_undo, can_redo) = state.history.can_undo_and_redo();
        let is_selected = state.selected.is_some();
        let mut button = |enabled: bool, icon: &str, name: &str, hint: &str| {
            ui.add_enabled_ui(enabled, |ui| icons::button(ui, icon, name, hint).clicked()).inner
        };
        if button(is_selected, icons::REMOVE, "Remove", "The selected thing (Delete)") {
            remove(state, actions, now);
        }
        if button(can_undo, icons::UNDO, "Undo", "Ctrl + Z") {
            undo(state, actions);
        }
        if button(can_redo, icons::REDO, "Redo", "Ctrl + Shift + Z") {
            redo(state, actions);
        }
    });
}

fn keys(ctx: &Context, state: &mut State, actions: &mut Vec<Action>) {
    // A change that is in progress ends first.
    if ctx.egui_wants_keyboard_input() || state.moving.is_some() || state.typing.is_some() {
        return;
    }
    let now = ctx.input(|input| input.time);
    let pressed = |modifiers, key| ctx.input_mut(|input| input.consume_key(modifiers, key));
    if pressed(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z) || pressed(Modifiers::COMMAND, Key::Y) {
        redo(state, actions);
    }
    if pressed(Modifiers::COMMAND, Key::Z) {
        undo(state, actions);
    }
    if pressed(Modifiers::NONE, Key::Delete) {
        remove(state, actions, now);
    }
}

fn remove(state: &mut State, actions: &mut Vec<Action>, now: f64) {
    let Some(item) = state.selected.take() else { return };
    let before = state.scene.clone();
    item.remove(&mut state.scene);
    finish(state, before, actions, now);
}
