//! Errors when opening the window.

use splashdown::error::CheckpointError;
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
    /// The display cannot be used.
    #[error(
        "no window could be opened: {reason}. Check that DISPLAY or WAYLAND_DISPLAY names a running display"
    )]
    Display {
        /// The system's message.
        reason: String,
    },
    /// The device that was named cannot draw into the window, or there is none.
    #[error("no window could be opened: {reason}")]
    NoDevice {
        /// The message of [`splashdown_gpu::GpuError`], which contains a hint.
        reason: String,
    },
    /// A driver that cannot open windows.
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
    /// The checkpoint cannot be used.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
}
