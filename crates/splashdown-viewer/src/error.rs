//! What can go wrong before the window is there.

use splashdown_render::RenderError;

/// Why there is no window.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ViewerError {
    /// No screen.
    #[error(
        "no window could be opened: this session has no display (neither DISPLAY nor WAYLAND_DISPLAY is set). Start it on a \
         desktop, or let `splashdown run` write pictures and a film"
    )]
    NoDisplay,
    /// No driver, or one that does not show windows.
    #[error("no window could be opened: {reason}. A window needs a graphics driver: {hint}")]
    NoWindow {
        /// What the system says.
        reason: String,
        /// How to get a driver.
        hint: &'static str,
    },
    /// The device cannot draw.
    #[error(transparent)]
    Render(#[from] RenderError),
}
