//! The status line, and the dialog of all numbers.

use egui::{Grid, Rect, RichText, ScrollArea, TextStyle, Ui};

use super::dialog;
use crate::state::{Figures, State};
use crate::timeline::Timeline;

/// One line at every width: the numbers that fit, the most important ones first.
pub(super) fn show(ui: &mut Ui, state: &mut State) {
    let items = items(&state.figures, state.timeline.as_ref());
    ui.horizontal(|ui| {
        let (font, colour) = (TextStyle::Monospace.resolve(ui.style()), ui.visuals().text_color());
        let mut left = ui.available_width();
        for (text, hint) in items {
            let galley = ui.painter().layout_no_wrap(text, font.clone(), colour);
            let needed = galley.size().x + ui.spacing().item_spacing.x;
            if needed > left {
                break;
            }
            left -= needed;
            ui.label(galley).on_hover_text(hint);
        }
    });
}

/// The numbers with their explanations. Their widths do not change with every picture.
fn items(figures: &Figures, played: Option<&Timeline>) -> Vec<(String, &'static str)> {
    let is_played = played.is_some();
    let mut items = vec![(format!("time {:7.3} s ", figures.time), "Simulated time")];
    if !is_played {
        let hint = "Actual time scale: simulated seconds per second, recent average";
        items.push((format!("actual {:4.2} x ", figures.speed), hint));
    }
    if played.is_none_or(|timeline| timeline.has_particles) {
        items.push((format!("{} particles ", count(figures.particles.into())), "Number of particles"));
    }
    if !is_played {
        let rate = match figures.frames_per_second {
            0.0 => "  -".to_owned(),
            rate => format!("{rate:3.0}"),
        };
        items.push((format!("{rate} pictures/s "), "Pictures per second of this window while it plays"));
    }
    if let Some(triangles) = figures.triangles {
        items.push((format!("{} triangles ", count(triangles.into())), "Triangles of the surface"));
    }
    if !is_played {
        items.push((
            format!("{:5.0} steps/s ", figures.steps_per_second),
            "Time steps of the simulation per second",
        ));
        items.push((figures.device.clone(), "Simulating device"));
    }
    items
}

/// The dialog of all numbers, with the time per pass.
pub(super) fn show_statistics(ctx: &egui::Context, state: &mut State, over: Rect) {
    let (figures, tolerance) = (&state.figures, state.scene.solver.tolerance);
    let shown = &mut state.shown;
    dialog::new("Statistics", over).open(&mut shown.statistics).resizable(false).show(ctx, |ui| {
        ScrollArea::vertical().max_height(dialog::inner_height(over)).show(ui, |ui| {
            Grid::new("numbers").striped(true).num_columns(2).show(ui, |ui| {
                for (name, text) in numbers(figures, tolerance) {
                    ui.label(name);
                    ui.monospace(text);
                    ui.end_row();
                }
            });
            ui.toggle_value(&mut shown.timings, "Time per pass")
                .on_hover_text("Measuring slows the simulation down a little");
            if shown.timings {
                timings(ui, figures);
            }
        });
    });
    // Passes are not timed for a closed dialog.
    shown.timings &= shown.statistics;
}

fn numbers(figures: &Figures, tolerance: f32) -> Vec<(&'static str, String)> {
    let mut numbers = vec![
        ("device", figures.device.clone()),
        ("memory", format!("{:.0} MB", figures.memory as f64 / 1e6)),
        ("steps per second", format!("{:.0}", figures.steps_per_second)),
        ("time step", seconds(figures.dt.into())),
        ("density error", format!("{:.1} %", 100.0 * figures.density_error)),
    ];
    if figures.mean_height.is_finite() {
        numbers.push(("mean height", format!("{:.3} m", figures.mean_height)));
    }
    if figures.iterations > 0.0 {
        numbers.push(("pressure iterations per step", format!("{:.1}", figures.iterations)));
        let residual = format!("{:.3} % (tolerance {:.3} %)", 100.0 * figures.residual, 100.0 * tolerance);
        numbers.push(("pressure residual", residual));
        numbers.push(("mean density excess", format!("{:.2} %", 100.0 * figures.compression)));
    }
    if figures.viscous_iterations > 0.0 {
        numbers.push(("viscosity iterations per step", format!("{:.1}", figures.viscous_iterations)));
    }
    numbers
}

fn timings(ui: &mut Ui, figures: &Figures) {
    if figures.timings.passes.is_empty() && figures.drawing.is_empty() {
        ui.label("No times yet, or this device has no timestamps.");
        return;
    }
    let steps = figures.timed_steps.max(1) as f64;
    Grid::new("timings").striped(true).num_columns(2).show(ui, |ui| {
        let mut row = |name: RichText, time: f64| {
            ui.label(name);
            ui.monospace(seconds(time));
            ui.end_row();
        };
        let mut passes: Vec<_> = figures.timings.passes.iter().collect();
        passes.sort_by_key(|(_, time)| std::cmp::Reverse(time.total));
        for (label, time) in passes {
            row(RichText::new(*label), time.total.as_secs_f64() / steps);
        }
        row(RichText::new("step").strong(), figures.timings.total().as_secs_f64() / steps);
        let mut picture = 0.0;
        for (label, milliseconds) in &figures.drawing {
            row(RichText::new(*label), 1e-3 * f64::from(*milliseconds));
            picture += 1e-3 * f64::from(*milliseconds);
        }
        row(RichText::new("picture").strong(), picture);
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
    fn the_status_line_omits_what_does_not_exist() {
        let has = |figures: &Figures, played: Option<&Timeline>, word: &str| {
            items(figures, played).iter().any(|(text, _)| text.contains(word))
        };
        let mut figures = Figures::default();
        let mut timeline = Timeline::new(vec![0, 1], 30.0).unwrap();
        // A run without particles, such as one that wrote the surface only.
        timeline.has_particles = false;
        assert!(!has(&figures, Some(&timeline), "particles"));
        timeline.has_particles = true;
        assert!(has(&figures, Some(&timeline), "0 particles") && has(&figures, None, "0 particles"));
        // The rate of pictures is that of a window that plays.
        assert!(has(&figures, None, "  - pictures/s"));
        figures.frames_per_second = 59.8;
        assert!(has(&figures, None, " 60 pictures/s"));
    }

    #[test]
    fn numbers_are_formatted() {
        assert_eq!(count(999), "999");
        assert_eq!(count(1_234_567), "1 234 567");
        assert_eq!(seconds(0.000_25), "250 us");
        assert_eq!(seconds(0.0125), "12.50 ms");
    }
}
