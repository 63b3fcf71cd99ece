//! Tests releases with a temporary copy of this repository's files.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use semver::Version;
use tempfile::TempDir;

use super::{citation, manifest, prepare};
use crate::command::{output, program, root, run};
use crate::metadata::Metadata;

const DATE: &str = "2031-02-03";
const CITATION: &str =
    "cff-version: 1.2.0\ntitle: Splashdown\nversion: 0.0.1\ndate-released: \"2030-01-01\"\n";

/// A committed copy of the files that a release changes, with a changelog that lists one change.
fn copy() -> Result<TempDir> {
    let folder = TempDir::new()?;
    for name in ["Cargo.toml", "Cargo.lock"] {
        fs::copy(root().join(name), folder.path().join(name))?;
    }
    fs::write(
        folder.path().join("CHANGELOG.md"),
        "# Changelog\n\n## [Unreleased]\n\n### Added\n\n- Lib: a change.\n",
    )?;
    fs::write(folder.path().join("CITATION.cff"), CITATION)?;
    git(folder.path(), &["init", "--quiet"])?;
    commit(folder.path())?;
    Ok(folder)
}

fn git(folder: &Path, arguments: &[&str]) -> Result<()> {
    run(&mut program("git", folder, arguments))
}

fn commit(folder: &Path) -> Result<()> {
    git(folder, &["add", "--all"])?;
    let identity =
        ["-c", "user.name=tests", "-c", "user.email=tests@example.com", "-c", "commit.gpgsign=false"];
    git(folder, &[&identity[..], &["commit", "--quiet", "--message", "Copy"]].concat())
}

fn next(folder: &Path) -> Result<Version> {
    let old = manifest::version(&fs::read_to_string(folder.join("Cargo.toml"))?)?;
    Ok(Version::new(old.major, old.minor + 1, 0))
}

fn refusal(folder: &Path, version: &Version) -> String {
    prepare(folder, version, DATE).err().map_or_else(String::new, |error| format!("{error:#}"))
}

#[test]
fn a_release_changes_every_file_that_contains_the_version() -> Result<()> {
    let folder = copy()?;
    let version = next(folder.path())?;
    let before = fs::read_to_string(folder.path().join("Cargo.toml"))?;
    for edit in prepare(folder.path(), &version, DATE)? {
        edit.write()?;
    }
    let read = |name: &str| fs::read_to_string(folder.path().join(name));
    let after = read("Cargo.toml")?;
    assert_eq!(manifest::version(&after)?, version);
    let old = manifest::version(&before)?;
    let expected = before.replace(&format!("version = \"{old}\""), &format!("version = \"{version}\""));
    assert_eq!(after, expected, "comments and layout of Cargo.toml are preserved");
    let lock = read("Cargo.lock")?;
    for name in ["splashdown", "splashdown-cli", "xtask"] {
        assert!(
            lock.contains(&format!("name = \"{name}\"\nversion = \"{version}\"\n")),
            "{name} in Cargo.lock"
        );
    }
    let changed = output(&mut program("git", folder.path(), ["diff", "--numstat", "Cargo.lock"]))?;
    let members = Metadata::ask(&["--no-deps", "--offline"])?.packages.len();
    assert!(changed.starts_with(&format!("{members}\t{members}\t")), "{changed}");
    assert_eq!(
        read("CHANGELOG.md")?,
        format!(
            "# Changelog\n\n## [Unreleased]\n\n## [{version}] - {DATE}\n\n### Added\n\n- Lib: a change.\n"
        )
    );
    let citation = read("CITATION.cff")?;
    assert!(citation.contains(&format!("\nversion: {version}\n")), "{citation}");
    assert!(citation.contains(&format!("\ndate-released: \"{DATE}\"\n")), "{citation}");
    assert!(citation.starts_with("cff-version: 1.2.0\n"), "{citation}");
    Ok(())
}

#[test]
fn a_version_that_does_not_increase_is_rejected() -> Result<()> {
    let folder = copy()?;
    let old = manifest::version(&fs::read_to_string(folder.path().join("Cargo.toml"))?)?;
    assert!(refusal(folder.path(), &old).contains("must increase"));
    assert!(refusal(folder.path(), &Version::new(0, 0, 1)).contains("must increase"));
    Ok(())
}

#[test]
fn a_working_tree_with_changes_is_rejected() -> Result<()> {
    let folder = copy()?;
    let version = next(folder.path())?;
    assert_eq!(refusal(folder.path(), &version), "");
    fs::write(folder.path().join("new.txt"), "new")?;
    let message = refusal(folder.path(), &version);
    assert!(message.contains("has changes") && message.contains("new.txt"), "{message}");
    Ok(())
}

#[test]
fn an_empty_or_repeated_section_of_the_changelog_is_rejected() -> Result<()> {
    let folder = copy()?;
    let version = next(folder.path())?;
    let path = folder.path().join("CHANGELOG.md");
    let cases = [
        ("# Changelog\n".to_owned(), "no section"),
        ("## [Unreleased]\n\n## [0.0.1] - 2030-01-01\n\n- Lib: old.\n".to_owned(), "lists no changes"),
        (format!("## [Unreleased]\n\n- x\n\n## [{version}] - 2030-01-01\n"), "already"),
    ];
    for (text, word) in cases {
        fs::write(&path, text)?;
        commit(folder.path())?;
        let message = refusal(folder.path(), &version);
        assert!(message.contains(word), "{message}");
    }
    Ok(())
}

#[test]
fn a_dependency_with_another_version_is_rejected() -> Result<()> {
    let folder = copy()?;
    let version = next(folder.path())?;
    let path = folder.path().join("Cargo.toml");
    let text = fs::read_to_string(&path)?;
    let line = text.lines().find(|line| line.starts_with("splashdown-gpu")).context("a dependency")?;
    let other = line.replace("version = \"", "version = \"9");
    fs::write(&path, text.replace(line, &other))?;
    commit(folder.path())?;
    assert!(refusal(folder.path(), &version).contains("splashdown-gpu has version"));
    Ok(())
}

#[test]
fn a_citation_without_a_date_gets_one() -> Result<()> {
    let text = citation::released("version: 1.0.0\ntitle: x", &Version::new(1, 1, 0), DATE)?;
    assert_eq!(text, format!("version: 1.1.0\ntitle: x\ndate-released: {DATE}\n"));
    assert!(citation::released("title: x\n", &Version::new(1, 1, 0), DATE).is_err());
    Ok(())
}
