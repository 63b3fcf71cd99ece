//! The commands, one file each.

pub mod bench;
pub mod check;
pub mod completions;
pub mod doctor;
#[cfg(feature = "plot")]
pub mod plot;
pub mod render;
pub mod run;
pub mod scenes;
pub mod surface;
#[cfg(feature = "window")]
pub mod view;

#[cfg(not(all(feature = "plot", feature = "window")))]
use crate::exit::{Exit, Failure};

/// The error for a command that this build does not include.
#[cfg(not(all(feature = "plot", feature = "window")))]
pub fn not_included(command: &str, feature: &str) -> Failure {
    let message = format!(
        "this program was built without `splashdown {command}`: it needs the feature `{feature}`, which \
         `cargo build --release --package splashdown-cli` and `cargo install --path crates/splashdown-cli` include"
    );
    Failure::new(Exit::Usage, message)
}
