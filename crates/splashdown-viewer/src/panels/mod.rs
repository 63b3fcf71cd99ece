//! The panels. Each shows and changes a part of the state, and requests actions.

mod change;
mod dialog;
mod edit;
mod fields;
mod figures;
mod gallery;
mod gravity;
mod handles;
mod help;
mod icons;
mod more;
mod notes;
mod settings;
mod timeline;
mod toolbar;
mod touch;
mod viewport;

use egui::{Panel, Ui};

use crate::state::{Action, Ask, State};

pub use change::{apply as change_things, at_start as change_at_start};
pub use viewport::Viewport;

/// Shows all panels. `picture` is the texture in the middle. Returns the viewport, which determines the size of the next
/// picture, and the requested actions.
pub fn show(ui: &mut Ui, state: &mut State, picture: Option<egui::TextureId>) -> (Viewport, Vec<Action>) {
    let mut actions = Vec::new();
    if !icons::install(ui.ctx()) {
        // Fonts can be used from the next pass on, which egui makes before it shows anything.
        ui.ctx().request_discard("the font of the icons");
        return (Viewport { rect: ui.max_rect(), size: [1, 1], touched: None }, actions);
    }
    touch::fit_tooltips(ui.ctx());
    help::keys(ui.ctx(), state, &mut actions);
    Panel::top("toolbar").resizable(false).show(ui, |ui| toolbar::show(ui, state, &mut actions));
    Panel::bottom("status").resizable(false).show(ui, |ui| figures::show(ui, state));
    if state.timeline.is_some() {
        Panel::bottom("timeline").resizable(false).show(ui, |ui| timeline::show(ui, state, &mut actions));
    }
    let viewport = egui::CentralPanel::default()
        .frame(egui::Frame::NONE)
        .show(ui, |ui| viewport::show(ui, state, picture, &mut actions))
        .inner;
    let over = notes::show(ui.ctx(), state, viewport.rect);
    settings::show(ui.ctx(), state, &mut actions, over);
    edit::show(ui.ctx(), state, &mut actions, over);
    gallery::show(ui.ctx(), state, &mut actions, over);
    help::show(ui.ctx(), state, over);
    // The statistics are those of a simulation.
    state.shown.statistics &= state.timeline.is_none();
    figures::show_statistics(ui.ctx(), state, over);
    (viewport, actions)
}

/// The buttons that add a mesh from a file. A web page has no dialogs.
fn add_mesh(ui: &mut Ui, actions: &mut Vec<Action>) {
    if cfg!(target_arch = "wasm32") {
        return;
    }
    for (text, hint, ask) in [
        ("Add mesh", "A floating body from an OBJ, STL, PLY or glTF file", Ask::Body),
        ("Fill mesh", "Fluid in a closed mesh from a file, at time 0: the scene restarts", Ask::Fluid),
    ] {
        if ui.button(text).on_hover_text(hint).clicked() {
            actions.push(Action::Ask(ask));
        }
    }
}
