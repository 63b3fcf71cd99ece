//! Keyboard shortcuts and their help.

use egui::{Context, Event, Grid, Key, Label, Rect, RichText, ScrollArea};
use glam::Vec3;
use splashdown::scene::Scene;

use super::{change, dialog};
use crate::edit;
use crate::look::DisplayMode;
use crate::state::{Action, Ask, State};
use crate::timeline::Timeline;

/// The lines of the help.
const LINES: [(&str, &str); 25] = [
    ("drag", "orbit the camera (with the tool Orbit)"),
    ("right or middle drag", "pan"),
    ("wheel, pinch", "zoom"),
    ("W A S D, Q E", "fly"),
    ("F", "reset the camera"),
    ("Shift + drag", "drag the fluid and dynamic bodies"),
    ("Delete", "remove the selected thing (with the tool Edit)"),
    ("Ctrl + Z, Ctrl + Shift + Z", "undo, redo (with the tool Edit)"),
    ("Space", "play, pause"),
    (".", "step: simulate one frame of the scene"),
    ("arrows, Home, End", "frames of a run that is played"),
    ("R", "restart at time 0, with the changes"),
    ("1, 2, ...", "views of the fluid"),
    ("B", "add a ball"),
    ("P", "add an emitter, or remove it"),
    ("drop a file", "open a scene, checkpoint or run; add a mesh as a body"),
    ("G", "choose a scene"),
    ("C", "settings"),
    ("T", "export a picture"),
    ("M", "export the surface"),
    ("K", "export a checkpoint to continue from"),
    ("Ctrl + S", "save the scene with its changes"),
    ("Ctrl + Shift + S", "save the scene with its changes, as a file to choose"),
    ("Ctrl + O", "open a scene or a checkpoint"),
    ("H", "this help"),
];

/// Handles keys, unless a text field has the focus.
pub(super) fn keys(ctx: &Context, state: &mut State, actions: &mut Vec<Action>) {
    if ctx.egui_wants_keyboard_input() {
        return;
    }
    // The modifiers are those of the key event. Those at the end of a slow frame may differ.
    let struck = |wanted: Key, command: bool, shift: Option<bool>| {
        ctx.input(|input| {
            input.events.iter().any(|event| match event {
                Event::Key { key, pressed: true, repeat: false, modifiers, .. } => {
                    let shifted = shift.is_none_or(|shift| shift == modifiers.shift);
                    *key == wanted && modifiers.command == command && !modifiers.alt && shifted
                }
                _ => false,
            })
        })
    };
    let pressed = |key| struck(key, false, None);
    let down = |key| ctx.input(|input| input.key_down(key) && !input.modifiers.command);
    // A change that is in progress ends first.
    let is_changing = state.moving.is_some() || state.typing.is_some();
    if let Some(timeline) = &mut state.timeline {
        playback_keys(timeline, pressed);
    } else if pressed(Key::Space) && !is_changing {
        actions.push(Action::Play(!state.playing));
    }
    let is_simulated = state.timeline.is_none();
    for (key, action) in [
        (Key::Period, Action::Step),
        (Key::R, Action::Restart),
        (Key::M, Action::ExportSurface),
        (Key::K, Action::ExportCheckpoint),
    ] {
        if is_simulated && !is_changing && pressed(key) {
            actions.push(action);
        }
    }
    for (key, change) in
        [(Key::B, edit::add_ball as fn(&mut Scene)), (Key::P, edit::toggle_emitter as fn(&mut Scene))]
    {
        if is_simulated && !is_changing && pressed(key) {
            change::apply(state, actions, ctx.input(|input| input.time), change);
        }
    }
    if pressed(Key::T) {
        actions.push(Action::ExportPicture);
    }
    if is_simulated && struck(Key::S, true, Some(false)) {
        actions.push(Action::SaveScene);
    }
    if cfg!(not(target_arch = "wasm32")) {
        if is_simulated && struck(Key::S, true, Some(true)) {
            actions.push(Action::Ask(Ask::SaveScene));
        }
        if struck(Key::O, true, Some(false)) {
            actions.push(Action::Ask(Ask::Scene));
        }
    }
    if pressed(Key::H) || pressed(Key::F1) {
        state.shown.help = !state.shown.help;
    }
    if pressed(Key::G) {
        state.shown.gallery = !state.shown.gallery;
        actions.push(Action::ShowFiles);
    }
    if pressed(Key::C) {
        state.shown.settings = !state.shown.settings;
    }
    if pressed(Key::Escape) {
        (state.shown.help, state.shown.gallery, state.shown.statistics) = (false, false, false);
    }
    if pressed(Key::F) {
        state.orbit = crate::camera::Orbit::of_scene(&state.scene);
    }
    let numbers = [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6];
    for (key, mode) in numbers.into_iter().zip(DisplayMode::ALL) {
        if pressed(key) {
            state.look.mode = mode;
        }
    }
    let along = |plus, minus| f32::from(u8::from(down(plus))) - f32::from(u8::from(down(minus)));
    let direction = Vec3::new(along(Key::D, Key::A), along(Key::E, Key::Q), along(Key::W, Key::S));
    if direction != Vec3::ZERO {
        let seconds = ctx.input(|input| input.stable_dt).min(0.1);
        state.orbit.fly(direction, seconds);
        ctx.request_repaint();
    }
}

/// The keys of a run that is played.
fn playback_keys(timeline: &mut Timeline, pressed: impl Fn(Key) -> bool) {
    let (first, last) = timeline.range();
    if pressed(Key::Space) {
        timeline.toggle();
    }
    if pressed(Key::ArrowRight) || pressed(Key::Period) {
        timeline.step(1);
    }
    if pressed(Key::ArrowLeft) {
        timeline.step(-1);
    }
    if pressed(Key::Home) {
        timeline.seek(first);
    }
    if pressed(Key::End) {
        timeline.seek(last);
    }
}

pub(super) fn show(ctx: &Context, state: &mut State, over: Rect) {
    dialog::new("Help", over).open(&mut state.shown.help).resizable(false).show(ctx, |ui| {
        ScrollArea::vertical().max_height(dialog::inner_height(over)).show(ui, |ui| {
            let keys = 110.0;
            let what = (over.width() - keys - 70.0).clamp(120.0, 330.0);
            Grid::new("keys").num_columns(2).striped(true).show(ui, |ui| {
                for (key, meaning) in LINES {
                    for (text, width) in [(RichText::new(key).strong(), keys), (RichText::new(meaning), what)]
                    {
                        ui.vertical(|ui| {
                            ui.set_width(width);
                            ui.add(Label::new(text).wrap());
                        });
                    }
                    ui.end_row();
                }
            });
        });
    });
}
