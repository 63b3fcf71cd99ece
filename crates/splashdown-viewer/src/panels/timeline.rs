//! The timeline of a run that is played.

use egui::{Slider, Ui};

use super::icons;
use crate::state::{Action, State};
use crate::timeline::{SPEEDS, Timeline};

/// Below this width, in points, the buttons have a row of their own.
const ONE_ROW: f32 = 800.0;

pub(super) fn show(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>) {
    let Some(timeline) = &mut state.timeline else { return };
    if ui.available_width() < ONE_ROW {
        ui.horizontal(|ui| position(ui, timeline, ui.available_width()));
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            buttons(ui, timeline);
            options(ui, timeline, actions);
        });
        return;
    }
    ui.horizontal(|ui| {
        buttons(ui, timeline);
        let rest = if timeline.can_continue { 250.0 } else { 170.0 };
        position(ui, timeline, ui.available_width() - rest);
        options(ui, timeline, actions);
    });
}

fn buttons(ui: &mut Ui, timeline: &mut Timeline) {
    let (first, last) = timeline.range();
    if icons::button(ui, icons::FIRST, "First frame", "Home").clicked() {
        timeline.seek(first);
    }
    if icons::button(ui, icons::PREVIOUS, "Previous frame", "Left arrow").clicked() {
        timeline.step(-1);
    }
    let (icon, name) = if timeline.playing { (icons::PAUSE, "Pause") } else { (icons::PLAY, "Play") };
    if icons::button(ui, icon, name, "Space").clicked() {
        timeline.toggle();
    }
    if icons::button(ui, icons::NEXT, "Next frame", "Right arrow").clicked() {
        timeline.step(1);
    }
    if icons::button(ui, icons::LAST, "Last frame", "End").clicked() {
        timeline.seek(last);
    }
}

/// The slider over the frames, and the number of the current one, in this width.
fn position(ui: &mut Ui, timeline: &mut Timeline, width: f32) {
    let (first, last) = timeline.range();
    let digits = last.to_string().len();
    let text = format!("frame {:>digits$} of {last}", timeline.current());
    let label = 8.0 * text.len() as f32;
    ui.spacing_mut().slider_width = (width - label).max(60.0);
    let mut frame = timeline.current();
    // A run of one frame has no range.
    let slider = Slider::new(&mut frame, first..=last.max(first.saturating_add(1))).show_value(false);
    let slider = ui.add(slider).on_hover_text("Drag to another frame");
    if slider.changed() {
        timeline.seek(frame);
    }
    // Keys are those of the window, not of the slider.
    slider.surrender_focus();
    ui.monospace(text);
}

fn options(ui: &mut Ui, timeline: &mut Timeline, actions: &mut Vec<Action>) {
    if icons::toggle(ui, icons::LOOP, "Loop", "Start again after the last frame", timeline.looping).clicked()
    {
        timeline.looping = !timeline.looping;
    }
    let speed = egui::DragValue::new(&mut timeline.speed)
        .range(SPEEDS)
        .clamp_existing_to_range(true)
        .speed(0.02)
        .max_decimals(2)
        .prefix("speed ")
        .suffix(" x");
    ui.add(speed).on_hover_text("Simulated seconds per second: drag, or click to type");
    if timeline.can_continue
        && ui.button("Continue").on_hover_text("Continue the simulation from the newest checkpoint").clicked()
    {
        actions.push(Action::Continue);
    }
    if !timeline.left_out.is_empty() {
        ui.weak(format!("{} left out", timeline.left_out.len()))
            .on_hover_text(format!("Frames that cannot be read: {:?}", timeline.left_out));
    }
}
