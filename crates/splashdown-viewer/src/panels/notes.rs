//! Notifications. Messages disappear after some seconds, errors when the user closes them.

use egui::{Align2, Area, Color32, Context, Frame, Id, ProgressBar, Rect, RichText};

use crate::state::State;

pub(super) fn show(ctx: &Context, state: &mut State, over: Rect) {
    let now = ctx.input(|input| input.time);
    state.notes.retain(|note| note.until > now);
    if state.notes.is_empty() && state.preparing.is_none() && state.reading.is_none() {
        return;
    }
    let mut closed = None;
    Area::new(Id::unique("notes"))
        .pivot(Align2::LEFT_TOP)
        .fixed_pos(over.left_top() + egui::vec2(10.0, 10.0))
        .show(ctx, |ui| {
            ui.set_max_width((over.width() - 20.0).clamp(120.0, 520.0));
            if let Some((what, part)) = &state.preparing {
                ui.add(ProgressBar::new(*part).text(what).desired_width(240.0));
            }
            if let Some(name) = &state.reading {
                Frame::popup(ui.style()).show(ui, |ui| {
                    ui.horizontal_wrapped(|ui| {
                        ui.spinner();
                        ui.label(format!("reading {name}"));
                    });
                });
            }
            for (number, note) in state.notes.iter().enumerate() {
                Frame::popup(ui.style()).show(ui, |ui| {
                    let text = RichText::new(&note.text);
                    let text = if note.is_error {
                        text.color(Color32::from_rgb(220, 80, 60)).strong()
                    } else {
                        text
                    };
                    ui.horizontal_wrapped(|ui| {
                        ui.label(text);
                        if note.is_error && ui.small_button("close").clicked() {
                            closed = Some(number);
                        }
                    });
                });
            }
        });
    if let Some(number) = closed {
        state.notes.remove(number);
    }
    // Without a repaint, a message would remain until the next input.
    ctx.request_repaint_after(std::time::Duration::from_millis(500));
}
