//! Sizes of controls for fingers, in small windows as on a phone.

use egui::{Context, Ui};

/// The smallest width and height of a window, in points, in which controls have their usual size.
const USUAL: egui::Vec2 = egui::vec2(700.0, 500.0);
/// Height of a control for fingers, in points.
pub const HEIGHT: f32 = 32.0;
/// The largest width of a tooltip, in points, and its space to the edges of the window.
const TOOLTIP: [f32; 2] = [500.0, 40.0];

/// Makes controls large enough for fingers in a small window.
pub fn enlarge(ui: &mut Ui) {
    let window = ui.ctx().content_rect().size();
    if window.x >= USUAL.x && window.y >= USUAL.y {
        return;
    }
    let text = ui.text_style_height(&egui::TextStyle::Button);
    let spacing = ui.spacing_mut();
    spacing.interact_size.y = HEIGHT;
    spacing.button_padding.y = spacing.button_padding.y.max(0.5 * (HEIGHT - text));
}

/// Limits the width of tooltips to that of the window.
pub fn fit_tooltips(ctx: &Context) {
    let [largest, space] = TOOLTIP;
    let width = (ctx.content_rect().width() - space).clamp(100.0, largest);
    if ctx.global_style().spacing.tooltip_width != width {
        ctx.all_styles_mut(|style| style.spacing.tooltip_width = width);
    }
}
