//! What can go wrong before the window is there.

use splashdown_render::RenderError;

/// Why there is no window.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ViewerError {
    /// No display, or no driver.
    #[error(
        "no window could be opened: {reason}. A window needs a display (on a machine without one: `splashdown run`, which writes \
         pictures) and a graphics driver ({hint})"
    )]
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
