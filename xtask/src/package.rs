//! Release commands: packages of the crates, archives, version. The crate `splashdown-packaging` implements the last
//! two, so that this program does not need its dependencies.

use anyhow::{Result, ensure};

use crate::process::{self, cargo};
use crate::report;

/// The command `package`: packs every published crate and builds it from its package.
pub fn run(arguments: &[String]) -> Result<()> {
    ensure!(arguments.is_empty(), "package takes no arguments, got {}", arguments.join(" "));
    // Without `--workspace` cargo takes the default members: `crates/*`, which are the published ones.
    process::run(&mut cargo(["package", "--allow-dirty"]))
}

/// The command `dist`.
pub fn dist(arguments: &[String]) -> Result<()> {
    process::run(packaging().arg("dist").args(arguments))
}

/// The command `release`.
pub fn release(arguments: &[String]) -> Result<()> {
    process::run(packaging().arg("release").args(arguments).args(["--date", &report::date()]))
}

fn packaging() -> std::process::Command {
    cargo(["run", "--quiet", "--package", "splashdown-packaging", "--"])
}
