//! The timeline of a run that is played.

use egui::{Slider, Ui};

use super::{icons, touch};
use crate::state::{Action, State};
use crate::timeline::{TIME_SCALES, Timeline};

/// Below this width, in points, the buttons have a row of their own.
const ONE_ROW: f32 = 800.0;

/// Width of the options in one row, in points.
const OPTIONS: f32 = 260.0;
/// Number of frames without files that a tooltip names.
const NAMED: usize = 20;

pub(super) fn show(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>) {
    let Some(timeline) = &mut state.timeline else { return };
    touch::enlarge(ui);
    if ui.available_width() < ONE_ROW {
        ui.horizontal(|ui| position(ui, timeline, ui.available_width()));
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            buttons(ui, timeline);
            options(ui, timeline, actions, "");
        });
        return;
    }
    ui.horizontal(|ui| {
        buttons(ui, timeline);
        position(ui, timeline, ui.available_width() - OPTIONS);
        options(ui, timeline, actions, "time scale ");
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
    let missing = timeline.left_out.len();
    let note = if missing > 0 { format!("{missing} left out") } else { String::new() };
    let label = 8.0 * (text.len() + note.len()) as f32 + 2.0 * ui.spacing().item_spacing.x;
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
    if missing > 0 {
        ui.weak(note).on_hover_text(format!("Frames that cannot be read: {}", shortened(&timeline.left_out)));
    }
}

/// The first numbers of a list.
fn shortened(numbers: &[u32]) -> String {
    let named: Vec<String> = numbers.iter().take(NAMED).map(u32::to_string).collect();
    let more = numbers.len() - named.len();
    named.join(", ") + &if more > 0 { format!(" and {more} more") } else { String::new() }
}

/// Repetition, time scale and continuation. `prefix` stands in front of the time scale.
fn options(ui: &mut Ui, timeline: &mut Timeline, actions: &mut Vec<Action>, prefix: &str) {
    if icons::toggle(ui, icons::LOOP, "Loop", "Start again after the last frame", timeline.looping).clicked()
    {
        timeline.looping = !timeline.looping;
    }
    let scale = egui::DragValue::new(&mut timeline.time_scale)
        .range(TIME_SCALES)
        .clamp_existing_to_range(true)
        .speed(0.02)
        .max_decimals(2)
        .prefix(prefix)
        .suffix(" x");
    ui.add(scale).on_hover_text("Time scale: simulated seconds per second: drag, or click to type");
    let button = ui.add_enabled(timeline.can_continue, egui::Button::new("Continue"));
    let button = button
        .on_hover_text("Continue the simulation from the newest checkpoint")
        .on_disabled_hover_text(
            "This run has no checkpoint to continue from. The option --checkpoint-every of splashdown run writes checkpoints, \
             and so does Ctrl + C",
        );
    if button.clicked() {
        actions.push(Action::Continue);
    }
}
