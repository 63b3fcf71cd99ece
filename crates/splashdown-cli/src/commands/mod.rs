//! One file per word after `splashdown`.

pub mod bench;
pub mod check;
pub mod completions;
pub mod doctor;
pub mod run;
pub mod scenes;
pub mod view;
