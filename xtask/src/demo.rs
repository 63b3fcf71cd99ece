//! The first command of the README: builds what the dam break needs and runs it.

use std::time::Instant;

use anyhow::{Result, bail};

use crate::process::{self, say};
use crate::setup;

/// Output folder of the demo.
const OUT: &str = "out/dam-break";

/// The window, plots and collisions are not built: the demo uses none of them, and they are more than half of the crates.
pub const BUILD: [&str; 1] = ["--no-default-features"];

/// The command `demo`. Arguments are passed to `splashdown run`.
pub fn run(arguments: &[String]) -> Result<()> {
    setup::ensure_requirements()?;
    let binary = process::build_release_with(&BUILD)?;
    let mut command = process::command(&binary);
    command.args(["run", "dam-break"]);
    if !arguments.iter().any(|argument| argument == "--out" || argument.starts_with("--out=")) {
        command.args(["--out", OUT]);
    }
    command.args(arguments);
    say(format!("Running: {}", process::line(&command)));
    let start = Instant::now();
    let status = command.status()?;
    if !status.success() {
        bail!("`{}` failed ({status})", process::line(&command));
    }
    say(format!("Demo: {:.1} s without the build.", start.elapsed().as_secs_f64()));
    Ok(())
}
