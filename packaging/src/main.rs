//! Builds release archives and the Debian package, sets the version number, and lists the packages in the program.
//! `cargo xtask dist`, `cargo xtask release` and `cargo xtask sbom` start this program; it is a separate crate so that `xtask` has few dependencies.

mod command;
mod dist;
mod metadata;
#[cfg(test)]
mod packages;
mod release;
mod sbom;

use std::process::ExitCode;

use anyhow::{Result, bail};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &[String]) -> Result<()> {
    match arguments.split_first() {
        Some((word, rest)) if word == "dist" => dist::run(rest),
        Some((word, rest)) if word == "release" => release::run(rest),
        Some((word, rest)) if word == "sbom" => sbom::run(rest),
        _ => bail!(
            "this program is started by `cargo xtask dist`, `cargo xtask release` and `cargo xtask sbom`"
        ),
    }
}
