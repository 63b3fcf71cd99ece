//! The real-time program: a fluid in a window or on a web page, to look at and to play with.
//!
//! ```text
//! panels (egui)  --Action-->  app  --Command-->  engine (thread or task)  --Snapshot-->  picture (splashdown-render)
//! ```
//!
//! Data flows in a circle of four parts, each of which knows only the next: panels change [`state::State`] and
//! say what they want done; the app does it; the engine simulates beside the window and hands out copies of
//! what is to be seen; the picture draws the newest copy. So the window stays quick however slow the simulation
//! is.

mod app;
pub mod camera;
mod edit;
pub mod engine;
mod error;
mod export;
pub mod look;
#[cfg(target_arch = "wasm32")]
mod page;
pub mod panels;
mod pick;
pub mod picture;
mod pixels;
pub mod save;
pub mod state;
mod thumbnails;
#[cfg(not(target_arch = "wasm32"))]
mod window;

pub use app::Viewer;
pub use error::ViewerError;
#[cfg(target_arch = "wasm32")]
pub use page::{figures, start_on_page, try_passes};
#[cfg(not(target_arch = "wasm32"))]
pub use window::{ViewOptions, view};
