//! Releases: the crates as packages, the archives, the version. The last two are the work of the crate
//! `splashdown-packaging`, whose dependencies this program does without.

use anyhow::{Result, ensure};

use crate::process::{self, cargo};
use crate::report;

/// The word `package`: packs every published crate and builds it from its package.
pub fn run(arguments: &[String]) -> Result<()> {
    ensure!(arguments.is_empty(), "package takes no arguments, got {}", arguments.join(" "));
    // Without `--workspace` cargo takes the default members: `crates/*`, which are the published ones.
    process::run(&mut cargo(["package", "--allow-dirty"]))
}

/// The word `dist`.
pub fn dist(arguments: &[String]) -> Result<()> {
    process::run(packaging().arg("dist").args(arguments))
}

/// The word `release`.
pub fn release(arguments: &[String]) -> Result<()> {
    process::run(packaging().arg("release").args(arguments).args(["--date", &report::date()]))
}

fn packaging() -> std::process::Command {
    cargo(["run", "--quiet", "--package", "splashdown-packaging", "--"])
}
