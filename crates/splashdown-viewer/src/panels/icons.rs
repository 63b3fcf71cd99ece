//! Icons: characters of a font with the icons of this program, with names for screen readers and tests.
//!
//! The font is a part of Phosphor Icons 2.1 (MIT), five kilobytes instead of five hundred, because the web page has to
//! fetch it. `fonts/README.md` says how it is made.

use egui::epaint::text::{FontInsert, FontPriority, InsertFontFamily};
use egui::{Button, Context, FontData, FontFamily, Id, Response, Role, Ui, WidgetInfo};

pub const FIRST: &str = "\u{e5a4}";
pub const LAST: &str = "\u{e5a6}";
pub const LOOP: &str = "\u{e3f6}";
pub const MORE: &str = "\u{e2f0}";
pub const NEXT: &str = "\u{e13a}";
pub const PAUSE: &str = "\u{e39e}";
pub const PLAY: &str = "\u{e3d0}";
pub const PREVIOUS: &str = "\u{e138}";
pub const RESTART: &str = "\u{e038}";
pub const SCENE: &str = "\u{e256}";
pub const SETTINGS: &str = "\u{e434}";
pub const STEP: &str = "\u{e064}";
pub const VIEW: &str = "\u{e220}";

pub const REDO: &str = "\u{e08c}";
pub const REMOVE: &str = "\u{e4a6}";
pub const UNDO: &str = "\u{e08a}";

pub const DRAG: &str = "\u{e57c}";
pub const EDIT: &str = "\u{e3b4}";
pub const ORBIT: &str = "\u{e7a4}";
pub const SHAKE: &str = "\u{e0a0}";
pub const TILT: &str = "\u{e7bc}";

/// All icons.
#[cfg(test)]
const ALL: [&str; 21] = [
    FIRST, LAST, LOOP, MORE, NEXT, PAUSE, PLAY, PREVIOUS, RESTART, SCENE, SETTINGS, STEP, VIEW, DRAG, ORBIT,
    SHAKE, TILT, EDIT, REDO, REMOVE, UNDO,
];

/// Width of a button with an icon, in points.
pub const WIDTH: f32 = 28.0;

/// Adds the font of the icons; returns whether it was there already. It can be used from the next pass on.
pub fn install(ctx: &Context) -> bool {
    let is_there = ctx.data_mut(|data| {
        let flag = data.get_temp_mut_or_default::<bool>(Id::unique("icons"));
        std::mem::replace(flag, true)
    });
    if !is_there {
        let family = |family| InsertFontFamily { family, priority: FontPriority::Lowest };
        let data = FontData::from_static(include_bytes!("../../fonts/icons.ttf"));
        let families = vec![family(FontFamily::Proportional), family(FontFamily::Monospace)];
        ctx.add_font(FontInsert { name: "icons".to_owned(), data, families });
    }
    is_there
}

/// A button with an icon. The name is read by screen readers and shown in front of the hint.
pub fn button(ui: &mut Ui, icon: &str, name: &str, hint: &str) -> Response {
    toggle(ui, icon, name, hint, false)
}

/// A button with an icon that is highlighted while `selected`.
pub fn toggle(ui: &mut Ui, icon: &str, name: &str, hint: &str, selected: bool) -> Response {
    let height = ui.spacing().interact_size.y;
    let button = Button::new(icon).selected(selected).min_size(egui::vec2(WIDTH, height));
    let response = ui.add(button).on_hover_text(format!("{name}: {hint}"));
    named(&response, name, selected);
    response
}

/// Gives a button that shows an icon its name.
pub fn named(response: &Response, name: &str, selected: bool) {
    let (is_enabled, name) = (response.enabled(), name.to_owned());
    response.widget_info(move || WidgetInfo::selected(Role::Button, is_enabled, selected, name.clone()));
}

#[cfg(test)]
mod tests {
    use super::{ALL, install};

    #[test]
    fn the_font_contains_every_icon() {
        let ctx = egui::Context::default();
        assert!(!install(&ctx) && install(&ctx));
        let mut missing = Vec::new();
        let mut output = ctx.run_ui(egui::RawInput::default(), |ui| {
            let font = egui::FontId::proportional(14.0);
            let has =
                |icon: &str| icon.chars().all(|c| ui.ctx().fonts_mut(|fonts| fonts.has_glyph(&font, c)));
            missing = ALL.into_iter().filter(|icon| !has(icon)).collect();
            // Control: an icon that is not part of the font.
            assert!(!has("\u{e1da}"));
        });
        // No texture is drawn in this test.
        output.textures_delta.clear();
        assert!(missing.is_empty(), "{missing:?}");
    }
}
