//! The scenes that come with the program.

use egui::{Context, ScrollArea, Window};

use crate::state::{Action, State};
use crate::thumbnails;

pub(super) fn show(ctx: &Context, state: &mut State, actions: &mut Vec<Action>) {
    let mut chosen = None;
    Window::new("Scenes").open(&mut state.shown.gallery).default_width(640.0).show(ctx, |ui| {
        ScrollArea::vertical().max_height(440.0).show(ui, |ui| {
            ui.horizontal_wrapped(|ui| {
                for (name, about) in thumbnails::scenes() {
                    ui.vertical(|ui| {
                        ui.set_width(thumbnails::WIDTH);
                        let clicked = match thumbnails::texture(ui.ctx(), name) {
                            Some(texture) => {
                                let size = egui::vec2(thumbnails::WIDTH, thumbnails::WIDTH * 9.0 / 16.0);
                                ui.add(egui::Button::image((texture, size))).on_hover_text(&about).clicked()
                            }
                            None => false,
                        };
                        if ui.selectable_label(state.scene.name == name, name).on_hover_text(about).clicked()
                            || clicked
                        {
                            chosen = Some(name);
                        }
                    });
                }
            });
        });
    });
    if let Some(name) = chosen {
        actions.push(Action::OpenPreset(name));
        state.shown.gallery = false;
    }
}
