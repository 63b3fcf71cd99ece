//! The checks against measurements at full resolution: the same tests as in `cargo xtask test`, which read this variable
//! and then take the particle spacing and the duration of the measurement instead of the small ones.

use anyhow::{Result, ensure};

use crate::layers::{Report, filtered};
use crate::process;

/// The word `validate`.
pub fn run(arguments: &[String]) -> Result<()> {
    ensure!(arguments.is_empty(), "validate takes no arguments, got {}", arguments.join(" "));
    let mut report = Report::default();
    report.layer("physics at full resolution", |filter| {
        let words =
            ["test", "--release", "--package", "splashdown", "--test", "physics", "--", "--show-output"];
        let mut command = process::cargo(words);
        filtered(command.env("SPLASHDOWN_FULL", "1"), filter)
    });
    report.close()
}
