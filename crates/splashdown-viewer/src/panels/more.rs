//! The menu of everything that is needed rarely: files, export, theme, statistics, help.

use egui::containers::menu::MenuButton;
use egui::{Button, Ui, vec2};

use super::{icons, toolbar};
use crate::state::{Action, Ask, State};

pub(super) fn show(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>, has_words: bool) {
    let button = Button::new(icons::MORE).min_size(vec2(icons::WIDTH, 0.0));
    let (response, _) = MenuButton::from_button(button).ui(ui, |ui| {
        let is_simulated = state.timeline.is_none();
        if is_simulated && !has_words {
            toolbar::time_scale(ui, state, actions);
        }
        if cfg!(not(target_arch = "wasm32")) {
            files(ui, state, actions);
        }
        let hint = "With its changes, into a new file beside its file (Ctrl + S)";
        if is_simulated && ui.button("Save scene").on_hover_text(hint).clicked() {
            actions.push(Action::SaveScene);
        }
        ui.separator();
        export(ui, state, actions);
        ui.separator();
        let hint = "Restart with the scene as its file defines it";
        if is_simulated && ui.button("Discard changes").on_hover_text(hint).clicked() {
            actions.push(Action::DiscardChanges);
        }
        if ui.button("Reset camera").on_hover_text("The view of the scene (F)").clicked() {
            state.orbit = crate::camera::Orbit::of_scene(&state.scene);
        }
        ui.separator();
        if is_simulated
            && ui.button("Statistics").on_hover_text("Numbers of the simulation, time per pass").clicked()
        {
            state.shown.statistics = !state.shown.statistics;
        }
        if ui.button("Light or dark").clicked() {
            actions.push(Action::SwapTheme);
        }
        if ui.button("Help").on_hover_text("Keys and mouse (H)").clicked() {
            state.shown.help = !state.shown.help;
        }
    });
    toolbar::described(&response, "More", "Open, save, export, statistics and help");
}

/// The dialogs of a desktop.
fn files(ui: &mut Ui, state: &State, actions: &mut Vec<Action>) {
    for (text, hint, ask) in [
        ("Open scene...", "A scene or a checkpoint (Ctrl + O)", Ask::Scene),
        ("Open run...", "The folder of a finished or interrupted run, to play it", Ask::Run),
        ("Save scene as...", "With its changes, as a file to choose (Ctrl + Shift + S)", Ask::SaveScene),
        ("Add mesh...", "A floating body from an OBJ, STL, PLY or glTF file", Ask::Body),
    ] {
        // A run that is played cannot be changed.
        let is_possible = state.timeline.is_none() || matches!(ask, Ask::Scene | Ask::Run);
        if is_possible && ui.button(text).on_hover_text(hint).clicked() {
            actions.push(Action::Ask(ask));
        }
    }
}

fn export(ui: &mut Ui, state: &State, actions: &mut Vec<Action>) {
    if ui.button("Export picture").on_hover_text("As PNG (T)").clicked() {
        actions.push(Action::ExportPicture);
    }
    // A finished run has these files already.
    if state.timeline.is_some() {
        return;
    }
    for (text, hint, action) in [
        (
            "Export checkpoint",
            "To continue from, here or on the command line (K). Drop the file onto the window to continue",
            Action::ExportCheckpoint,
        ),
        ("Export surface", "As closed triangles in PLY (M)", Action::ExportSurface),
    ] {
        if ui.button(text).on_hover_text(hint).clicked() {
            actions.push(action);
        }
    }
    // Only a web page has an address that a link can open, and only a desktop has folders for films.
    if cfg!(target_arch = "wasm32") {
        if ui.button("Export link").on_hover_text("A link that opens the scene with its changes").clicked() {
            actions.push(Action::Share);
        }
        return;
    }
    let text = match state.recorded {
        Some(frames) => format!("End film ({frames} pictures)"),
        None => "Export film".to_owned(),
    };
    let hint = "A picture of every frame of the scene, and a film if ffmpeg is installed. The simulation steps frame by \
                frame until the film is ended here";
    if ui.button(text).on_hover_text(hint).clicked() {
        actions.push(Action::Record);
    }
}
