//! The changelog: the unreleased changes become the section of the new version, below a new empty section.

use anyhow::{Context, Result, ensure};
use semver::Version;

const UNRELEASED: &str = "## [Unreleased]\n";

/// The changelog with the section of the new version.
pub fn released(text: &str, version: &Version, date: &str) -> Result<String> {
    let text = text.replace("\r\n", "\n");
    let (before, after) =
        text.split_once(UNRELEASED).context("CHANGELOG.md has no section `## [Unreleased]`")?;
    let section = after.split("\n## ").next().unwrap_or_default();
    let entries = section.lines().any(|line| line.starts_with("- ") || line.starts_with("* "));
    ensure!(entries, "the section `## [Unreleased]` of CHANGELOG.md lists no changes");
    ensure!(!text.contains(&format!("## [{version}]")), "CHANGELOG.md already has a section for {version}");
    Ok(format!("{before}{UNRELEASED}\n## [{version}] - {date}\n{after}"))
}
