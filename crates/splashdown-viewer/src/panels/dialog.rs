//! Dialogs: windows over the picture that never cover the toolbar.

use egui::{Id, Rect, Vec2, Window, vec2};

/// Space between a dialog and the edges of the picture, in points.
const MARGIN: f32 = 6.0;
/// Height of the title and the frame of a dialog, in points.
const TITLE: f32 = 56.0;

/// A dialog that stays inside the picture, `over`.
pub fn new(title: &'static str, over: Rect) -> Window<'static> {
    let inside = over.shrink2(Vec2::splat(MARGIN));
    Window::new(title)
        .id(Id::unique(title))
        .collapsible(false)
        .default_pos(inside.left_top() + vec2(10.0, 10.0))
        .max_width(inside.width() - 24.0)
        .default_height(inner_height(over))
        .constrain_to(inside)
}

/// The height that a list in a dialog can have.
pub fn inner_height(over: Rect) -> f32 {
    (over.height() - 2.0 * MARGIN - TITLE).max(60.0)
}
