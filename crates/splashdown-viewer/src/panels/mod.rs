//! The panels. Each shows and changes a part of the state, and requests actions.

mod controls;
mod figures;
mod gallery;
mod gravity;
mod help;
mod icons;
mod notes;
mod timeline;
mod toolbar;
mod viewport;

use egui::{Panel, Ui};

use crate::state::{Action, State};

pub use viewport::Viewport;

/// Windows narrower than this, in points, start with hidden controls.
const NARROW: f32 = 700.0;

/// Shows all panels. `picture` is the texture in the middle. Returns the viewport, which determines the size of the next
/// picture, and the requested actions.
pub fn show(ui: &mut Ui, state: &mut State, picture: Option<egui::TextureId>) -> (Viewport, Vec<Action>) {
    let mut actions = Vec::new();
    help::keys(ui.ctx(), state, &mut actions);
    Panel::top("toolbar").show(ui, |ui| toolbar::show(ui, state, &mut actions));
    Panel::bottom("figures").show(ui, |ui| figures::show(ui, state));
    if state.timeline.is_some() {
        Panel::bottom("timeline").show(ui, |ui| timeline::show(ui, state, &mut actions));
    }
    // On a phone the controls would cover the picture.
    let narrow = ui.max_rect().width() < NARROW;
    if std::mem::replace(&mut state.shown.narrow, narrow) != narrow {
        state.shown.bare = narrow;
    }
    if !state.shown.bare {
        Panel::right("controls")
            .resizable(true)
            .default_size(270.0)
            .size_range(220.0..=420.0)
            .show(ui, |ui| controls::show(ui, state, &mut actions));
    }
    let viewport = egui::CentralPanel::default()
        .frame(egui::Frame::NONE)
        .show(ui, |ui| viewport::show(ui, state, picture, &mut actions))
        .inner;
    notes::show(ui.ctx(), state, viewport.rect);
    gallery::show(ui.ctx(), state, &mut actions);
    help::show(ui.ctx(), state);
    figures::show_timings(ui.ctx(), state);
    (viewport, actions)
}
