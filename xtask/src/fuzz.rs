//! `cargo xtask fuzz`: a long search with the targets of the package `fuzz`.

use anyhow::Result;

use crate::process::{cargo, say};

/// The command `fuzz`; the arguments are those of the program.
pub fn run(arguments: &[String]) -> Result<()> {
    say("Findings are written to target/fuzz.");
    let mut command = cargo(["run", "--release", "--quiet", "--package", "fuzz", "--"]);
    let status = command.args(arguments).status()?;
    anyhow::ensure!(status.success(), "there are findings ({status})");
    Ok(())
}
