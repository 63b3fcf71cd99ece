//! The command line as a user sees it.

mod bad_input;
#[cfg(target_os = "linux")]
mod checkpoints;
mod going_on;
mod place;
mod plot;
mod runs;
mod splashsurf;
mod surface;
mod words;
