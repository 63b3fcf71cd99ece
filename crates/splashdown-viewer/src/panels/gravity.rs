//! The gravity dial: the position of the knob is the direction of gravity.

use egui::{Color32, Sense, Slider, SliderClamping, Stroke, Ui, vec2};
use glam::{Vec2, Vec3};

use crate::camera::Orbit;
use crate::state::{Action, State};

/// Diameter of the dial, in points.
const SIZE: f32 = 86.0;

pub(super) fn show(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        let (rect, response) = ui.allocate_exact_size(vec2(SIZE, SIZE), Sense::click_and_drag());
        let response = response.on_hover_text(
            "Drag the knob towards the direction of gravity in this view. Double-click to set it upright",
        );
        let radius = 0.5 * SIZE - 8.0;
        let before = state.scene.gravity;
        if response.double_clicked() {
            state.scene.gravity = state.upright;
        } else if let Some(at) = response.interact_pointer_pos().filter(|_| response.dragged()) {
            let knob = (at - rect.center()) / radius;
            state.scene.gravity = from_knob(Vec2::new(knob.x, knob.y), before, state.upright, &state.orbit);
        }
        let [right, up, _] = state.orbit.axes();
        let down = state.scene.gravity.normalize_or_zero();
        let knob = rect.center() + radius * vec2(down.dot(right), -down.dot(up));
        let visuals = ui.visuals();
        ui.painter().circle_stroke(rect.center(), radius, Stroke::new(1.0, visuals.weak_text_color()));
        ui.painter().line_segment([rect.center(), knob], Stroke::new(2.0, visuals.text_color()));
        ui.painter().circle_filled(knob, 7.0, Color32::from_rgb(60, 140, 200));
        ui.vertical(|ui| {
            let mut strength = state.scene.gravity.length();
            let slider = Slider::new(&mut strength, 0.0..=30.0)
                .clamping(SliderClamping::Edits)
                .suffix(" m/s²")
                .max_decimals(2);
            if ui.add(slider).on_hover_text("Earth 9.81, Moon 1.62, Mars 3.71 m/s²").changed() {
                let down = state
                    .scene
                    .gravity
                    .try_normalize()
                    .unwrap_or_else(|| state.upright.normalize_or(Vec3::NEG_Y));
                state.scene.gravity = strength * down;
            }
            if ui.button("upright").clicked() {
                state.scene.gravity = state.upright;
            }
        });
        if state.scene.gravity != before {
            actions.push(Action::Change);
        }
    });
}

/// Gravity of the same magnitude for a knob at this position of the dial, with y down and radius 1.
fn from_knob(knob: Vec2, before: Vec3, upright: Vec3, orbit: &Orbit) -> Vec3 {
    let strength = if before.length() > 1e-3 { before.length() } else { upright.length().max(9.81) };
    let [right, up, forward] = orbit.axes();
    let knob = knob.clamp_length_max(1.0);
    // Two directions have the same projection: choose the previous side.
    let side = if before.dot(forward) < 0.0 { -1.0 } else { 1.0 };
    let depth = side * (1.0 - knob.length_squared()).max(0.0).sqrt();
    strength * (knob.x * right - knob.y * up + depth * forward)
}

#[cfg(test)]
mod tests {
    use super::*;
    use splashdown::scene::{Scene, presets};

    #[test]
    fn the_knob_shows_the_direction_of_gravity() {
        let (name, text) = presets()[0];
        let scene = Scene::parse(text, name).unwrap();
        let orbit = Orbit::of_scene(&scene);
        let [right, up, _] = orbit.axes();
        for knob in [Vec2::new(0.3, 0.4), Vec2::new(-0.9, 0.1), Vec2::ZERO, Vec2::new(3.0, 4.0)] {
            let gravity = from_knob(knob, scene.gravity, scene.gravity, &orbit);
            assert!((gravity.length() - 9.81).abs() < 1e-3, "{gravity}");
            let seen = Vec2::new(gravity.dot(right), -gravity.dot(up)) / 9.81;
            assert!(seen.distance(knob.clamp_length_max(1.0)) < 1e-5, "{knob} {seen}");
        }
    }
}
