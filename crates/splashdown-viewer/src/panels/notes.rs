//! Notifications at the bottom of the picture. Messages disappear after some seconds, errors when the user closes them.

use std::time::Duration;

use egui::{Align2, Area, Color32, Context, Frame, Id, ProgressBar, Rect, RichText, ScrollArea, Ui, vec2};

use crate::state::{Note, State};

/// Space to the edges of the picture, in points.
const MARGIN: f32 = 8.0;
/// The largest width, in points.
const WIDTH: f32 = 520.0;
/// The largest height over that of the picture.
const PART: f32 = 0.3;
/// The largest and the smallest height of the list, in points.
const HEIGHTS: [f32; 2] = [140.0, 40.0];
/// Seconds until a message that has to disappear is looked at again.
const AGAIN: Duration = Duration::from_millis(500);

/// Shows them in the lower part of the picture, `over`, and returns the rest, in which dialogs lie.
pub(super) fn show(ctx: &Context, state: &mut State, over: Rect) -> Rect {
    let now = ctx.input(|input| input.time);
    state.notes.retain(|note| note.until > now);
    if state.notes.is_empty() && state.preparing.is_none() && state.reading.is_none() {
        return over;
    }
    let [most, least] = HEIGHTS;
    let height = (PART * over.height()).clamp(least, most);
    let area = Area::new(Id::unique("notes"))
        .pivot(Align2::LEFT_BOTTOM)
        .fixed_pos(over.left_bottom() + vec2(MARGIN, -MARGIN))
        .constrain_to(over)
        .show(ctx, |ui| {
            ui.set_max_width((over.width() - 2.0 * MARGIN).clamp(120.0, WIDTH));
            ScrollArea::vertical().max_height(height).show(ui, |ui| list(ui, state));
        });
    // Without a repaint, a message would remain until the next input.
    ctx.request_repaint_after(AGAIN);
    let bottom = over.bottom() - area.response.rect.height() - MARGIN;
    Rect::from_min_max(over.min, egui::pos2(over.right(), bottom.max(over.top())))
}

/// What is in progress, and the notifications, the newest first.
fn list(ui: &mut Ui, state: &mut State) {
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
    let mut closed = None;
    for (number, note) in state.notes.iter().enumerate().rev() {
        if Frame::popup(ui.style()).show(ui, |ui| one(ui, note)).inner {
            closed = Some(number);
        }
    }
    if let Some(number) = closed {
        state.notes.remove(number);
    }
}

/// A notification; returns whether it was closed.
fn one(ui: &mut Ui, note: &Note) -> bool {
    let text = RichText::new(&note.text);
    ui.horizontal_wrapped(|ui| match note.is_error {
        true => {
            ui.label(text.color(Color32::from_rgb(220, 80, 60)).strong());
            ui.small_button("close").clicked()
        }
        false => {
            ui.label(text);
            false
        }
    })
    .inner
}
