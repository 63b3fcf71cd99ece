//! The checks against measurements at full resolution: the same tests as in `cargo xtask test`, which read a variable and
//! then take the particle spacing and the duration of the measurement instead of the small ones.

use std::path::Path;

use anyhow::{Context, Result, ensure};

use crate::layers::{Report, filtered};
use crate::process::{self, say};

/// Where the figures go.
const FIGURES: &str = "out/validation";

/// The word `validate`.
pub fn run(arguments: &[String]) -> Result<()> {
    ensure!(arguments.is_empty(), "validate takes no arguments, got {}", arguments.join(" "));
    let folder = process::root().join(FIGURES);
    if folder.exists() {
        std::fs::remove_dir_all(&folder).with_context(|| format!("cannot empty {}", folder.display()))?;
    }
    let mut report = Report::default();
    report.layer("physics at full resolution", |filter| {
        let words =
            ["test", "--release", "--package", "splashdown", "--test", "physics", "--", "--show-output"];
        let mut command = process::cargo(words);
        filtered(command.env("SPLASHDOWN_FULL", "1").env("SPLASHDOWN_FIGURES", &folder), filter)
    });
    say("\n=== Figures");
    for table in left(&folder, "txt") {
        say(table.trim_end());
    }
    // Every file holds an array; one array of all their entries needs no more than the brackets' removal.
    let cases = left(&folder, "json");
    let entries: Vec<&str> = cases
        .iter()
        .filter_map(|case| Some(case.trim().strip_prefix('[')?.strip_suffix(']')?.trim()))
        .collect();
    let all = folder.join("report.json");
    std::fs::create_dir_all(&folder)?;
    std::fs::write(&all, format!("[\n  {}\n]\n", entries.join(",\n  ")))
        .with_context(|| format!("cannot write {}", all.display()))?;
    say(format!("\nAlso as JSON: {FIGURES}/report.json, and a file per case beside it."));
    report.close()
}

/// What the cases left in files that end so, in the order of their names.
fn left(folder: &Path, ending: &str) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<_> = entries.map(|entry| entry.path()).collect();
    files.retain(|file| file.extension().is_some_and(|end| end == ending));
    files.sort();
    files.iter().filter_map(|file| std::fs::read_to_string(file).ok()).collect()
}
