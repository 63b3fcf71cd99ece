//! The gallery of built-in scenes.

use egui::{Button, Context, Grid, Rect, ScrollArea, Ui, vec2};

use super::dialog;
use crate::state::{Action, State};
use crate::thumbnails;

/// Space between two pictures, in points.
const GAP: f32 = 12.0;
/// Height of the list of checkpoints, in points.
const FILES: f32 = 100.0;

pub(super) fn show(ctx: &Context, state: &mut State, actions: &mut Vec<Action>, over: Rect) {
    let (mut chosen, mut file) = (None, None);
    let files = if state.files.is_empty() { 0.0 } else { FILES };
    dialog::new("Scenes", over).open(&mut state.shown.gallery).default_width(800.0).show(ctx, |ui| {
        ScrollArea::vertical().max_height(dialog::inner_height(over) - files).show(ui, |ui| {
            let columns =
                ((ui.available_width() + GAP) / (thumbnails::WIDTH + GAP)).floor().max(1.0) as usize;
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
    if let Some(path) = file {
        actions.push(Action::OpenFile(path));
        state.shown.gallery = false;
    }
    if let Some(name) = chosen {
        actions.push(Action::OpenPreset(name));
        state.shown.gallery = false;
    }
}

/// A picture with its name below; returns whether it was clicked.
fn tile(ui: &mut Ui, name: &str, about: &str, is_open: bool) -> bool {
    let size = vec2(thumbnails::WIDTH, thumbnails::WIDTH * 9.0 / 16.0);
    ui.vertical(|ui| {
        ui.set_width(thumbnails::WIDTH);
        let picture = match thumbnails::texture(ui.ctx(), name) {
            Some(texture) => ui.add(Button::image((texture, size))),
            None => ui.add_sized(size, Button::new(name)),
        };
        let label = ui.selectable_label(is_open, name);
        picture.on_hover_text(about).clicked() || label.on_hover_text(about).clicked()
    })
    .inner
}
