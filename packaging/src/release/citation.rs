//! Version and date in `CITATION.cff` (Citation File Format 1.2.0), where they are top-level keys.

use anyhow::{Result, ensure};
use semver::Version;

/// The file with the new version and date.
pub fn released(text: &str, version: &Version, date: &str) -> Result<String> {
    let with_version = replace(text, "version", &version.to_string());
    ensure!(with_version.is_some(), "CITATION.cff has no top-level key `version`");
    let text = with_version.unwrap_or_default();
    Ok(replace(&text, "date-released", date).unwrap_or_else(|| {
        let end = if text.ends_with('\n') { "" } else { "\n" };
        format!("{text}{end}date-released: {date}\n")
    }))
}

/// The text with another value for a key at the start of a line; `None` if no line has the key.
fn replace(text: &str, key: &str, value: &str) -> Option<String> {
    let start = format!("{key}:");
    text.lines().any(|line| line.starts_with(&start)).then(|| {
        let line = |line: &str| match line.strip_prefix(&start) {
            Some(old) if old.trim().starts_with('"') => format!("{start} \"{value}\"\n"),
            Some(_) => format!("{start} {value}\n"),
            None => format!("{line}\n"),
        };
        text.lines().map(line).collect()
    })
}
