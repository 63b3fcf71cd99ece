//! The user guide in `docs/guide`: generates the map of the code, checks links, builds the HTML book.

mod book;
mod links;
pub mod map;
mod markdown;

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result, bail, ensure};

use crate::layers::Outcome;
use crate::process::{root, say};

/// Folder of the guide's pages, relative to the repository.
const PAGES: &str = "docs/guide/src";

/// Runs `cargo xtask guide`: writes the generated parts, checks all links and builds the book.
///
/// # Errors
/// If a file cannot be written, a link is broken, or the book cannot be built.
pub fn run(arguments: &[String]) -> Result<()> {
    ensure!(arguments.is_empty(), "guide takes no arguments, got {}", arguments.join(" "));
    for (path, text) in map::files()? {
        write_if_changed(&path, &text)?;
    }
    check_links()?;
    let folder = book::build()?;
    say(format!("The guide is at {}.", folder.join("index.html").display()));
    Ok(())
}

/// The layer `guide` of `cargo xtask test`: generated parts up to date, links valid, book built. mdBook is compiled only
/// with `all`; the layer is skipped if it cannot be installed.
///
/// # Errors
/// If a generated file is out of date, a link is broken, or the book has errors.
pub fn test(all: bool) -> Result<Outcome> {
    for (path, text) in map::files()? {
        let committed = fs::read_to_string(&path).unwrap_or_default().replace("\r\n", "\n");
        ensure!(committed == text, "{} is out of date: run `cargo xtask guide`", path.display());
    }
    check_links()?;
    if !all && book::installed().is_none() {
        say("mdBook is not installed: `cargo xtask guide` installs it and builds the book.");
        return Ok(Outcome::Passed);
    }
    if let Err(error) = book::program() {
        ensure!(!crate::process::is_ci(), "mdBook is not available: {error:#}");
        return Ok(Outcome::Skipped(format!("mdBook is not available: {error:#}")));
    }
    book::build()?;
    Ok(Outcome::Passed)
}

fn write_if_changed(path: &PathBuf, text: &str) -> Result<()> {
    if fs::read_to_string(path).is_ok_and(|old| old == text) {
        return Ok(());
    }
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))?;
    say(format!("Written: {}", path.strip_prefix(root()).unwrap_or(path).display()));
    Ok(())
}

/// Checks the links of all documents.
fn check_links() -> Result<()> {
    let (count, problems) = links::check(root())?;
    if !problems.is_empty() {
        bail!("broken links:\n  {}", problems.join("\n  "));
    }
    say(format!("{count} links between documents are valid."));
    Ok(())
}
