//! One file per word after `splashdown`.

pub mod bench;
pub mod check;
pub mod completions;
pub mod doctor;
pub mod plot;
pub mod run;
pub mod scenes;
pub mod surface;
pub mod view;
