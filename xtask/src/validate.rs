//! Validation against measurements at full resolution. It runs the physics tests of `cargo xtask test`; an environment
//! variable makes them use the particle spacing and the duration of the measurement instead of the small ones.

use std::path::Path;

use anyhow::{Context, Result, bail};

use crate::layers::{self, Report};
use crate::process::{self, say};

/// Output folder of the figures.
const FIGURES: &str = "out/validation";

/// The beginning of the page.
const HEAD: &str = "<!DOCTYPE html>
<html lang=\"en\">
<head>
<meta charset=\"utf-8\">
<title>Splashdown: validation</title>
<style>
body { font-family: sans-serif; max-width: 60em; margin: 2em auto; padding: 0 1em; }
table { border-collapse: collapse; margin: 1em 0; }
th, td { text-align: left; padding: 0.2em 1em 0.2em 0; border-bottom: 1px solid #ccc; }
td:nth-child(2) { font-variant-numeric: tabular-nums; text-align: right; }
svg { display: block; max-width: 100%; height: auto; margin: 1em 0; }
strong { color: #b00020; }
</style>
</head>
<body>
<h1>Splashdown: validation</h1>
<p>Dots are measurements, lines are simulations. Gates were set before the first run; missed gates are marked.</p>
";

/// The command `validate`.
pub fn run(arguments: &[String]) -> Result<()> {
    if let Some(option) = arguments.iter().find(|argument| argument.starts_with('-')) {
        bail!("validate takes names of cases, for example `spheric2`, or nothing for all; got {option}");
    }
    let folder = process::root().join(FIGURES);
    // The figures of one case replace its earlier ones; those of other cases remain.
    if folder.exists() && arguments.is_empty() {
        std::fs::remove_dir_all(&folder).with_context(|| format!("cannot empty {}", folder.display()))?;
    }
    let mut report = Report::default();
    report.layer("physics at full resolution", |filter| {
        let words =
            ["test", "--release", "--package", "splashdown", "--test", "physics", "--", "--show-output"];
        let mut command = process::cargo(words);
        command.args(arguments);
        command.env("SPLASHDOWN_FULL", "1").env("SPLASHDOWN_FIGURES", &folder);
        // Without a limit: a single case takes long at full resolution.
        layers::tests(&mut command, filter, None)
    });
    say("\n=== Figures");
    for table in contents(&folder, "txt") {
        say(table.trim_end());
    }
    // Each file contains an array; removing the brackets is enough to join their entries.
    let cases = contents(&folder, "json");
    let entries: Vec<&str> = cases
        .iter()
        .filter_map(|case| Some(case.trim().strip_prefix('[')?.strip_suffix(']')?.trim()))
        .collect();
    let all = folder.join("report.json");
    std::fs::create_dir_all(&folder)?;
    std::fs::write(&all, format!("[\n  {}\n]\n", entries.join(",\n  ")))
        .with_context(|| format!("cannot write {}", all.display()))?;
    let page = folder.join("report.html");
    let text = format!("{HEAD}{}</body>\n</html>\n", contents(&folder, "html").concat());
    std::fs::write(&page, text).with_context(|| format!("cannot write {}", page.display()))?;
    say(format!("\nAs a page with plots: {FIGURES}/report.html"));
    say(format!("Also as JSON: {FIGURES}/report.json, and a file per case beside it."));
    report.close()
}

/// The contents of the cases' files with this extension, in the order of their names.
fn contents(folder: &Path, ending: &str) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<_> = entries.map(|entry| entry.path()).collect();
    files.retain(|file| file.extension().is_some_and(|end| end == ending));
    files.sort();
    files.iter().filter_map(|file| std::fs::read_to_string(file).ok()).collect()
}
