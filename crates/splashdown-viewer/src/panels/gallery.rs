//! The gallery: recent scenes and runs, built-in scenes, and checkpoints.

use std::path::Path;

use egui::{Button, Context, Grid, Rect, ScrollArea, Ui, vec2};

use super::dialog;
use crate::state::{Action, Ask, RecentFile, State};
use crate::thumbnails;

/// Space between two pictures, in points.
const GAP: f32 = 12.0;
/// Height of the list of checkpoints, in points.
const FILES: f32 = 100.0;
/// Height of the row of buttons that open a dialog, in points.
const DIALOGS: f32 = 28.0;
/// Length of the longest name in the list of recent files, in characters.
const NAME: usize = 34;

pub(super) fn show(ctx: &Context, state: &mut State, actions: &mut Vec<Action>, over: Rect) {
    let (mut chosen, mut file) = (None, None);
    let mut requests = Vec::new();
    let files = if state.files.is_empty() { 0.0 } else { FILES };
    dialog::new("Scenes", over).open(&mut state.shown.gallery).default_width(800.0).show(ctx, |ui| {
        let dialogs = if cfg!(target_arch = "wasm32") { 0.0 } else { DIALOGS };
        if dialogs > 0.0 {
            ui.horizontal(|ui| open(ui, &mut requests));
        }
        ScrollArea::vertical().max_height(dialog::inner_height(over) - files - dialogs).show(ui, |ui| {
            recent(ui, &state.recent, &mut requests);
            let columns = ((ui.available_width() + GAP) / (tile_width(ui) + GAP)).floor().max(1.0) as usize;
            let scenes: Vec<_> = thumbnails::scenes().collect();
            Grid::new("scenes").spacing([GAP, GAP]).show(ui, |ui| {
                for row in scenes.chunks(columns) {
                    for (name, about) in row {
                        if tile(ui, name, about, state.scene.name == *name) {
                            chosen = Some(*name);
                        }
                    }
                    ui.end_row();
                }
            });
        });
        if !state.files.is_empty() {
            ui.separator();
            ui.label("Continue from a checkpoint:");
            ScrollArea::vertical().id_salt("files").max_height(FILES - 40.0).show(ui, |ui| {
                ui.horizontal_wrapped(|ui| {
                    for path in &state.files {
                        if ui.button(path.display().to_string().trim_start_matches("./")).clicked() {
                            file = Some(path.clone());
                        }
                    }
                });
            });
        }
    });
    if requests.iter().any(|request| matches!(request, Action::OpenFile { .. })) {
        state.shown.gallery = false;
    }
    actions.extend(requests);
    if let Some(path) = file {
        actions.push(Action::OpenFile { path, scene: None });
        state.shown.gallery = false;
    }
    if let Some(name) = chosen {
        actions.push(Action::OpenPreset(name));
        state.shown.gallery = false;
    }
}

/// The buttons that open a dialog of the desktop.
fn open(ui: &mut Ui, requests: &mut Vec<Action>) {
    for (text, hint, ask) in [
        ("Open scene...", "A scene or a checkpoint (Ctrl + O)", Ask::Scene),
        ("Open run...", "The folder of a finished or interrupted run, to play it", Ask::Run),
    ] {
        if ui.button(text).on_hover_text(hint).clicked() {
            requests.push(Action::Ask(ask));
        }
    }
}

/// The recent scenes and runs. Those that no longer exist are grey.
fn recent(ui: &mut Ui, files: &[RecentFile], requests: &mut Vec<Action>) {
    if files.is_empty() {
        return;
    }
    ui.horizontal_wrapped(|ui| {
        ui.label("Recent:");
        for file in files {
            let button = Button::new(short(&file.path)).truncate();
            let path = file.path.display().to_string();
            let response = ui.add_enabled(file.exists, button).on_hover_text(&path);
            if response.on_disabled_hover_text(format!("{path} no longer exists")).clicked() {
                let (path, scene) = (file.path.clone(), file.scene.clone());
                requests.push(Action::OpenFile { path, scene });
            }
        }
        if ui.small_button("Clear list").on_hover_text("Forget the recent scenes and runs").clicked() {
            requests.push(Action::ForgetRecent);
        }
    });
    ui.separator();
}

/// The last two parts of a path, of limited length.
fn short(path: &Path) -> String {
    let parts: Vec<_> = path.iter().rev().take(2).map(|part| part.to_string_lossy()).collect();
    let name = parts.into_iter().rev().collect::<Vec<_>>().join("/");
    let length = name.chars().count();
    match length > NAME {
        true => std::iter::once('…').chain(name.chars().skip(length - NAME + 1)).collect(),
        false => name,
    }
}

/// The width of a tile: a picture is a button with a padding.
fn tile_width(ui: &Ui) -> f32 {
    thumbnails::WIDTH + 2.0 * ui.spacing().button_padding.x
}

/// A picture with its name below; returns whether it was clicked.
fn tile(ui: &mut Ui, name: &str, about: &str, is_open: bool) -> bool {
    let size = vec2(thumbnails::WIDTH, thumbnails::WIDTH * 9.0 / 16.0);
    ui.vertical(|ui| {
        ui.set_width(tile_width(ui));
        let picture = match thumbnails::texture(ui.ctx(), name) {
            Some(texture) => ui.add(Button::image((texture, size))),
            None => ui.add_sized(size, Button::new(name)),
        };
        let label = ui.selectable_label(is_open, name);
        picture.on_hover_text(about).clicked() || label.on_hover_text(about).clicked()
    })
    .inner
}
