//! `cargo xtask release X.Y.Z`: sets the version number in every file that contains it, and updates the changelog.

mod changelog;
mod citation;
mod manifest;
#[cfg(test)]
mod tests;

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use semver::Version;

use crate::command::{output, program, root, run as execute, say};

/// The command `release`: a version, `--date YYYY-MM-DD` (`xtask` adds it), and `--commit` to commit and tag.
///
/// # Errors
/// If the version does not increase, the working tree has changes, or a file cannot be edited. Then no file is changed.
pub fn run(arguments: &[String]) -> Result<()> {
    let mut version = None;
    let mut date = None;
    let mut commit = false;
    let mut arguments = arguments.iter();
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--commit" => commit = true,
            "--date" => date = Some(arguments.next().context("--date needs a date, as in 2026-01-31")?),
            text if version.is_none() && !text.starts_with('-') => {
                version = Some(
                    Version::parse(text)
                        .with_context(|| format!("{text:?} is not a version; the format is 0.2.0"))?,
                );
            }
            other => bail!("release takes a version and --commit, got {other}"),
        }
    }
    let version = version.context("release needs a version, as in `cargo xtask release 0.2.0`")?;
    let date = date.context("release needs --date YYYY-MM-DD")?;
    let files = prepare(root(), &version, date)?;
    for file in &files {
        file.write()?;
        say(format!("Changed: {}", file.path.display()));
    }
    if commit {
        let paths = files.iter().map(|file| file.path.as_os_str());
        execute(program("git", root(), ["add", "--"]).args(paths))?;
        execute(&mut program(
            "git",
            root(),
            ["commit", "--quiet", "--message", &format!("Release {version}")],
        ))?;
        let tag = format!("v{version}");
        execute(&mut program(
            "git",
            root(),
            ["tag", "--annotate", &tag, "--message", &format!("Release {version}")],
        ))?;
        say(format!("Committed and tagged {tag}. Push both: `git push --follow-tags`."));
    } else {
        say(format!("Next: read `git diff`, run `cargo xtask test`, commit, and tag the commit v{version}."));
    }
    Ok(())
}

/// A file with its new contents.
struct Edit {
    path: PathBuf,
    text: String,
}

impl Edit {
    fn write(&self) -> Result<()> {
        fs::write(&self.path, &self.text).with_context(|| format!("cannot write {}", self.path.display()))
    }
}

/// Computes all changes of a release without writing them.
fn prepare(folder: &Path, version: &Version, date: &str) -> Result<Vec<Edit>> {
    ensure!(is_date(date), "{date:?} is not a date; the format is 2026-01-31");
    let changes = output(&mut program("git", folder, ["status", "--porcelain"]))?;
    ensure!(
        changes.is_empty(),
        "the working tree has changes; commit or stash them first:\n{}",
        changes.trim_end()
    );
    let read = |name: &str| {
        let path = folder.join(name);
        fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))
    };
    let manifest = read("Cargo.toml")?;
    let old = manifest::version(&manifest)?;
    ensure!(*version > old, "the version must increase: it is {old}, and {version} was requested");
    let edit = |name: &str, text: String| Edit { path: folder.join(name), text };
    let mut edits = vec![
        edit("Cargo.toml", manifest::with_version(&manifest, &old, version)?),
        edit("Cargo.lock", manifest::lock_with_version(&read("Cargo.lock")?, &old, version)?),
        edit("CHANGELOG.md", changelog::released(&read("CHANGELOG.md")?, version, date)?),
    ];
    if folder.join("CITATION.cff").exists() {
        edits.push(edit("CITATION.cff", citation::released(&read("CITATION.cff")?, version, date)?));
    }
    Ok(edits)
}

/// True for four, two and two digits separated by hyphens.
fn is_date(text: &str) -> bool {
    let parts: Vec<&str> = text.split('-').collect();
    let lengths: Vec<usize> = parts.iter().map(|part| part.len()).collect();
    lengths == [4, 2, 2] && parts.iter().all(|part| part.bytes().all(|byte| byte.is_ascii_digit()))
}
