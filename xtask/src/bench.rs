//! The numbers of `docs/performance.md`, each with the command that gives it.

use std::path::Path;

use anyhow::{Result, bail};

use crate::process::{self, say};

/// The word `bench`. The tables come from `splashdown bench`; this only chooses the sizes and writes the headings.
pub fn run(arguments: &[String]) -> Result<()> {
    let quick = match arguments {
        [] => false,
        [flag] if flag == "--quick" => true,
        other => bail!("bench takes --quick or nothing, got {}", other.join(" ")),
    };
    let binary = process::build_release()?;
    let largest = if quick { "8K,16K" } else { "64K" };
    let series = if quick { "8K,16K,32K" } else { "8K,16K,32K,64K,128K,256K,512K,1M" };
    let software = if quick { "8K" } else { "64K" };
    section(&binary, "One step on the CPU, by pass", &["--device", "cpu", "--particles", largest])?;
    section(
        &binary,
        "Cost per particle on the CPU",
        &["--device", "cpu", "--particles", series, "--no-passes"],
    )?;
    section(&binary, "On the best GPU", &["--device", "gpu", "--particles", series])?;
    section(
        &binary,
        "On software Vulkan, for the record",
        &["--device", "llvmpipe", "--particles", software],
    )?;
    Ok(())
}

/// One table. A device that is not there is said and passed over: the tables that can be made are worth having.
fn section(binary: &Path, title: &str, arguments: &[&str]) -> Result<()> {
    let mut command = process::command(binary);
    command.arg("bench").args(arguments);
    say(format!("\n## {title}\n\n`{}`\n", process::line(&command)));
    let status = command.status()?;
    match status.code() {
        Some(0) => Ok(()),
        Some(4) => {
            say("No such device on this machine.");
            Ok(())
        }
        _ => bail!("`{}` failed ({status})", process::line(&command)),
    }
}
