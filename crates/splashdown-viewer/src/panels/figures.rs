//! The status bar, and the table of time per pass.

use egui::{Grid, RichText, Ui, Window};

use crate::state::State;

pub(super) fn show(ui: &mut Ui, state: &mut State) {
    let figures = &state.figures;
    if state.timeline.is_some() {
        ui.horizontal_wrapped(|ui| {
            ui.monospace(format!("t = {:7.3} s", figures.time)).on_hover_text("Simulated time");
            ui.monospace(format!("{} particles", count(figures.particles.into())));
            if let Some(triangles) = figures.triangles {
                ui.monospace(format!("{} triangles", count(triangles.into())));
            }
        });
        return;
    }
    ui.horizontal_wrapped(|ui| {
        let mut item = |text: String, hint: &str| {
            ui.label(RichText::new(text).monospace()).on_hover_text(hint);
        };
        item(format!("{:3.0} frames/s", figures.frames_per_second), "Pictures per second of this window");
        item(format!("{:5.0} steps/s", figures.steps_per_second), "Time steps of the simulation per second");
        item(format!("{:.2} x real time", figures.speed), "Simulated seconds per second, recent average");
        item(format!("t = {:7.3} s", figures.time), "Simulated time");
        item(format!("dt = {}", seconds(figures.dt.into())), "Length of a time step");
        item(format!("{} particles", count(figures.particles.into())), "Number of particles");
        if figures.mean_height.is_finite() {
            item(format!("{:.3} m high", figures.mean_height), "Mean height of the particles");
        }
        if let Some(triangles) = figures.triangles {
            item(format!("{} triangles", count(triangles.into())), "Triangles of the surface");
        }
        item(
            format!("density +{:.1} %", 100.0 * figures.density_error),
            "Largest recent density above the rest density",
        );
        if figures.iterations > 0.0 {
            item(
                format!(
                    "{:.1} iterations, {:.2} % compressed",
                    figures.iterations,
                    100.0 * figures.compression
                ),
                "Pressure iterations per step, and mean density above the rest density",
            );
        }
        item(format!("{:.0} MB", figures.memory as f64 / 1e6), "Memory of the simulation's buffers");
        item(figures.device.clone(), "Simulating device");
        ui.toggle_value(&mut state.shown.timings, "time per pass")
            .on_hover_text("Time of each pass. Measuring slows the simulation down a little");
    });
}

pub(super) fn show_timings(ctx: &egui::Context, state: &mut State) {
    let figures = &state.figures;
    let steps = figures.timed_steps.max(1) as f64;
    Window::new("Time per pass").open(&mut state.shown.timings).resizable(false).show(ctx, |ui| {
        if figures.timings.passes.is_empty() && figures.drawing.is_empty() {
            ui.label("No times yet, or this device has no timestamps.");
            return;
        }
        Grid::new("timings").striped(true).num_columns(2).show(ui, |ui| {
            let mut passes: Vec<_> = figures.timings.passes.iter().collect();
            passes.sort_by_key(|(_, time)| std::cmp::Reverse(time.total));
            for (label, time) in passes {
                ui.label(*label);
                ui.monospace(seconds(time.total.as_secs_f64() / steps));
                ui.end_row();
            }
            ui.strong("step");
            ui.monospace(seconds(figures.timings.total().as_secs_f64() / steps));
            ui.end_row();
            let mut picture = 0.0;
            for (label, milliseconds) in &figures.drawing {
                ui.label(*label);
                ui.monospace(seconds(1e-3 * f64::from(*milliseconds)));
                ui.end_row();
                picture += 1e-3 * f64::from(*milliseconds);
            }
            ui.strong("picture");
            ui.monospace(seconds(picture));
            ui.end_row();
        });
    });
}

/// A time in a suitable unit.
fn seconds(seconds: f64) -> String {
    if seconds < 1e-3 { format!("{:.0} us", 1e6 * seconds) } else { format!("{:.2} ms", 1e3 * seconds) }
}

/// A number with separated thousands.
fn count(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_formatted() {
        assert_eq!(count(999), "999");
        assert_eq!(count(1_234_567), "1 234 567");
        assert_eq!(seconds(0.000_25), "250 us");
        assert_eq!(seconds(0.0125), "12.50 ms");
    }
}
