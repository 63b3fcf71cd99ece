//! The interactive program, in a window and on a web page.
//!
//! ```text
//! panels (egui)  --Action-->  app  --Command-->  engine (thread or task)  --Snapshot-->  picture (splashdown-render)
//! ```
//!
//! Four parts form a loop, and each depends only on the next. The panels change [`state::State`] and request actions. The
//! app executes them. The engine simulates concurrently with the window and publishes snapshots. The picture draws the
//! newest snapshot. The window therefore stays responsive if the simulation is slow.

mod app;
#[cfg(target_arch = "wasm32")]
mod browser;
pub mod camera;
#[cfg(not(target_arch = "wasm32"))]
mod dialogs;
mod edit;
pub mod engine;
mod error;
mod export;
#[cfg(any(target_arch = "wasm32", test))]
mod fit;
pub mod items;
pub mod look;
mod mouse;
#[cfg(not(target_arch = "wasm32"))]
mod opening;
#[cfg(target_arch = "wasm32")]
mod page;
pub mod panels;
mod pick;
pub mod picture;
mod pixels;
#[cfg(not(target_arch = "wasm32"))]
pub mod playback;
mod problem;
#[cfg(not(target_arch = "wasm32"))]
mod recent;
pub mod save;
pub mod state;
#[cfg(not(target_arch = "wasm32"))]
mod task;
mod thumbnails;
pub mod timeline;
#[cfg(not(target_arch = "wasm32"))]
mod window;

pub use app::Viewer;
#[cfg(target_arch = "wasm32")]
pub use browser::figures;
pub use error::ViewerError;
#[cfg(target_arch = "wasm32")]
pub use page::{start_on_page, try_passes};
#[cfg(not(target_arch = "wasm32"))]
pub use window::{Start, ViewOptions, view};
