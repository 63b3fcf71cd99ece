//! `cargo xtask shaders`: compiles the compute passes for GPUs that need not be present.

use std::path::Path;

use anyhow::{Result, bail, ensure};

use crate::layers::Outcome;
use crate::process::{self, cargo};

/// The report.
const PAGE: &str = "docs/shaders.md";
/// Where the description of Mesa's AMD driver lies.
const DRIVERS: &str = "/usr/share/vulkan/icd.d";

/// The command `shaders`.
pub fn run(arguments: &[String]) -> Result<()> {
    match arguments {
        [] => compile(&["--out", PAGE]),
        [flag, pass] if flag == "--assembly" => compile(&[flag, pass]),
        other => bail!("shaders takes --assembly PASS or nothing, got {}", other.join(" ")),
    }
}

/// All passes compile without spills, as a layer of the tests.
pub fn layer() -> Result<Outcome> {
    let drivers = std::fs::read_dir(Path::new(DRIVERS)).into_iter().flatten().flatten();
    let has_driver =
        drivers.into_iter().any(|file| file.file_name().to_string_lossy().starts_with("radeon_icd"));
    if !has_driver {
        return Ok(Outcome::Skipped(format!(
            "Mesa's AMD driver is not installed (no radeon_icd in {DRIVERS})"
        )));
    }
    compile(&[])?;
    Ok(Outcome::Passed)
}

fn compile(arguments: &[&str]) -> Result<()> {
    let mut command = cargo(["run", "--quiet", "--package", "splashdown-shaders", "--"]);
    let status = command.args(arguments).current_dir(process::root()).status()?;
    ensure!(status.success(), "the passes do not compile as they should ({status})");
    Ok(())
}
