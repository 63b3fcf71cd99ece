//! Icons: characters of the fonts that egui contains, with names for screen readers and tests.

use egui::{Button, Response, Role, Ui, WidgetInfo};

pub const FIRST: &str = "⏮";
pub const LAST: &str = "⏭";
pub const LOOP: &str = "🔁";
pub const NEXT: &str = "⏵";
pub const PAUSE: &str = "⏸";
pub const PLAY: &str = "▶";
pub const PREVIOUS: &str = "⏴";

/// All icons.
#[cfg(test)]
const ALL: [&str; 7] = [FIRST, LAST, LOOP, NEXT, PAUSE, PLAY, PREVIOUS];

/// Width of a button with an icon, in points.
const WIDTH: f32 = 28.0;

/// A button with an icon. The name is read by screen readers and shown in front of the hint.
pub fn button(ui: &mut Ui, icon: &str, name: &str, hint: &str) -> Response {
    toggle(ui, icon, name, hint, false)
}

/// A button with an icon that is highlighted while `selected`.
pub fn toggle(ui: &mut Ui, icon: &str, name: &str, hint: &str, selected: bool) -> Response {
    let height = ui.spacing().interact_size.y;
    let button = Button::new(icon).selected(selected).min_size(egui::vec2(WIDTH, height));
    let response = ui.add(button).on_hover_text(if hint.is_empty() {
        name.to_owned()
    } else {
        format!("{name}: {hint}")
    });
    let (is_enabled, name) = (ui.is_enabled(), name.to_owned());
    response.widget_info(move || WidgetInfo::selected(Role::Button, is_enabled, selected, name.clone()));
    response
}

#[cfg(test)]
mod tests {
    use super::ALL;

    #[test]
    fn the_fonts_contain_every_icon() {
        let ctx = egui::Context::default();
        let mut missing = Vec::new();
        let _ = ctx.run_ui(egui::RawInput::default(), |ui| {
            let font = egui::FontId::proportional(14.0);
            let has =
                |icon: &str| icon.chars().all(|c| ui.ctx().fonts_mut(|fonts| fonts.has_glyph(&font, c)));
            missing = ALL.into_iter().filter(|icon| !has(icon)).collect();
            // Control: a private character that no font has.
            assert!(!has("\u{e123}\u{f8ff}\u{10fffd}"));
        });
        assert!(missing.is_empty(), "{missing:?}");
    }
}
