//! The toolbar: scene, clock, tools, display modes.

use egui::{Button, RichText, Slider, SliderClamping, Ui};

use crate::look::DisplayMode;
use crate::state::{Action, State, Tool};

pub(super) fn show(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>) {
    ui.horizontal_wrapped(|ui| {
        let title = state.scene.name.clone();
        if ui.button(RichText::new(title).strong()).on_hover_text("Choose a scene (G)").clicked() {
            state.shown.gallery = !state.shown.gallery;
            actions.push(Action::ShowFiles);
        }
        ui.separator();
        if state.timeline.is_none() {
            clock(ui, state, actions);
        }
        for (number, mode) in DisplayMode::ALL.into_iter().enumerate() {
            let hint = format!("{} ({})", mode.hint(), number + 1);
            ui.selectable_value(&mut state.look.mode, mode, mode.name()).on_hover_text(hint);
        }
        ui.separator();
        let controls = if state.shown.bare { "Controls" } else { "Hide controls" };
        if ui.button(controls).on_hover_text("Show or hide the controls (C)").clicked() {
            state.shown.bare = !state.shown.bare;
        }
        if ui.button("Theme").on_hover_text("Light or dark").clicked() {
            actions.push(Action::SwapTheme);
        }
        if ui.button("Help").on_hover_text("Keys and mouse (H)").clicked() {
            state.shown.help = !state.shown.help;
        }
    });
}

/// What controls a simulation.
fn clock(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>) {
    let (sign, hint) = if state.playing { ("Pause", "Pause (Space)") } else { ("Play", "Play (Space)") };
    if ui.add(Button::new(sign).min_size([52.0, 0.0].into())).on_hover_text(hint).clicked() {
        actions.push(Action::Play(!state.playing));
    }
    if ui.button("Step").on_hover_text("One frame of the scene (.)").clicked() {
        actions.push(Action::Step);
    }
    if ui.button("Restart").on_hover_text("Restart with the changes (R)").clicked() {
        actions.push(Action::Restart);
    }
    if ui.button("Reset").on_hover_text("Restart without the changes").clicked() {
        actions.push(Action::Reset);
    }
    let speed = Slider::new(&mut state.time_scale, 0.05..=4.0)
        .clamping(SliderClamping::Edits)
        .logarithmic(true)
        .max_decimals(2)
        .suffix(" x")
        .text("speed");
    let speed = ui.add(speed).on_hover_text(
            "Simulated seconds per second. If the machine is too slow, the simulation runs slower; the window stays responsive",
        );
    if speed.changed() {
        actions.push(Action::TimeScale);
    }
    ui.separator();
    for tool in Tool::ALL {
        ui.selectable_value(&mut state.tool, tool, tool.name()).on_hover_text(tool.hint());
    }
    ui.separator();
}
