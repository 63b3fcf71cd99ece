//! Builds the HTML book with mdBook, which is installed into the target folder if the system has none.

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result, ensure};

use super::{PAGES, links};
use crate::process::{self, command, root, say, target};

/// The version to install. Any version of the same minor series on the search path is used instead.
const VERSION: &str = "0.5.4";

/// The program `mdbook`, if it is installed: on the search path, or by [`program`].
pub fn installed() -> Option<PathBuf> {
    [PathBuf::from("mdbook"), own()].into_iter().find(is_suitable)
}

/// Where [`program`] installs it.
fn own() -> PathBuf {
    tools().join("bin").join(format!("mdbook{}", std::env::consts::EXE_SUFFIX))
}

fn tools() -> PathBuf {
    target().join("tools")
}

/// The program `mdbook`. The first call installs it: about a minute of compilation on two cores.
///
/// # Errors
/// If `cargo install` fails, for example without a network.
pub fn program() -> Result<PathBuf> {
    if let Some(program) = installed() {
        return Ok(program);
    }
    let folder = tools();
    say(format!("Installing mdBook {VERSION} into {} ...", folder.display()));
    let build = folder.join("mdbook");
    let mut install = process::cargo(["install", "mdbook", "--locked", "--debug", "--no-default-features"]);
    install.args(["--quiet", "--features", "search", "--version", VERSION, "--root"]).arg(&folder);
    process::run(install.arg("--target-dir").arg(&build))?;
    // Only the program is needed; its intermediate files take several hundred megabytes.
    let _ = fs::remove_dir_all(&build);
    Ok(own())
}

fn is_suitable(program: &PathBuf) -> bool {
    let Ok(output) = command(program).arg("--version").output() else { return false };
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let series = VERSION.rsplit_once('.').map_or(VERSION, |(series, _)| series);
    text.trim().strip_prefix("mdbook v").is_some_and(|version| version.starts_with(&format!("{series}.")))
}

/// Builds the book and returns its folder. Warnings of mdBook are errors, and every file that a page links to must be in
/// the result.
///
/// # Errors
/// If mdBook fails or warns, or a file is missing.
pub fn build() -> Result<PathBuf> {
    let folder = target().join("guide");
    let mut build = command(program()?);
    build.args(["build", "docs/guide", "--dest-dir"]).arg(&folder);
    let output = build.output().context("cannot start mdbook")?;
    let text = String::from_utf8_lossy(&output.stderr);
    let has_warning = text.lines().any(|line| line.contains("WARN") || line.contains("ERROR"));
    ensure!(output.status.success() && !has_warning, "`{}` reports:\n{text}", process::line(&build));
    for page in links::pages(root())? {
        let html = folder.join(links::html_name(&page));
        ensure!(html.exists(), "mdBook wrote no {}", html.display());
    }
    for file in links::linked_files(root())? {
        let copy = folder.join(file.strip_prefix(PAGES).unwrap_or(&file));
        ensure!(copy.exists(), "mdBook did not copy {}", file.display());
    }
    Ok(folder)
}
