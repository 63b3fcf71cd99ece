//! The command line as a user sees it.

mod bad_input;
#[cfg(target_os = "linux")]
mod checkpoints;
mod guide;
mod place;
mod plot;
mod resume;
mod runs;
mod splashsurf;
mod surface;
mod words;
