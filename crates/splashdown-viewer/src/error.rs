//! Errors when opening the window.

use splashdown_render::RenderError;

/// Why the window cannot be opened.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ViewerError {
    /// No display.
    #[error(
        "no window could be opened: there is no display (neither DISPLAY nor WAYLAND_DISPLAY is set). Start it on a desktop, or \
         use `splashdown run` to write pictures and a film"
    )]
    NoDisplay,
    /// No driver, or one that cannot open windows.
    #[error("no window could be opened: {reason}. A window needs a graphics driver: {hint}")]
    NoWindow {
        /// The system's message.
        reason: String,
        /// How to install a driver.
        hint: &'static str,
    },
    /// The device cannot draw.
    #[error(transparent)]
    Render(#[from] RenderError),
}
