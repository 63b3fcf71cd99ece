//! The command `validate`: runs the physics cases at two or three resolutions, and writes the page of all figures and the tables
//! of the report.
//!
//! It runs the physics tests of `cargo xtask test`; environment variables select the resolutions and the folder of the
//! figures. The figures of each run replace its earlier ones in `docs/validation`, from which the page is written, so
//! that single cases can be repeated.

mod chart;
mod page;
mod record;
mod tables;

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};

use crate::layers::{self, Outcome, Report};
use crate::process::{self, say};
use crate::storms;

/// Where the tests write the figures of this call.
const FIGURES: &str = "out/validation";
/// The figures of all cases: one file per case.
const RECORDS: &str = "docs/validation";
/// The page, and the folder of its plots, relative to `docs`.
const PAGE: &str = "docs/validation-figures.md";
const PLOTS: &str = "pictures/validation";
/// The report, and which figures its tables show.
const REPORT: &str = "docs/validation.md";
const TABLES: &str = "docs/validation/tables.toml";

/// The command `validate`.
pub fn run(arguments: &[String]) -> Result<()> {
    // Random scenes have their own options and report.
    if let Some((first, rest)) = arguments.split_first()
        && first == "storms"
    {
        return storms::run(rest);
    }
    let (options, cases): (Vec<&String>, Vec<&String>) =
        arguments.iter().partition(|argument| argument.starts_with('-'));
    let variant = options.iter().find_map(|option| option.strip_prefix("--variant="));
    let across = options.iter().find_map(|option| option.strip_prefix("--across="));
    let device = options.iter().find_map(|option| option.strip_prefix("--device="));
    let is_known = |option: &str| {
        ["--quick", "--page"].contains(&option)
            || ["--variant=", "--across=", "--device="].iter().any(|start| option.starts_with(start))
    };
    if let Some(option) = options.iter().find(|option| !is_known(option.as_str())) {
        bail!(
            "validate takes names of tests, for example `waves`, nothing for all, or storms and its options; --quick leaves out the finest \
             resolution, --variant=NAME runs one column of each case, for example dfsph, --across=60,120 other \
             resolutions, --device=gpu runs on a GPU, and --page only adds the figures of the last call to the page; \
             got {option}"
        );
    }
    if options.len() > 1 && options.iter().any(|option| *option == "--page") {
        bail!("--page runs no case: leave the other options out");
    }
    if let Some(list) = across
        && !list.split(',').all(|number| number.parse::<u32>().is_ok_and(|number| number > 0))
    {
        bail!("--across takes numbers of spacings, for example 60,120, got {list}");
    }
    let has = |name: &str| options.iter().any(|option| *option == name);
    let mut report = Report::default();
    if !has("--page") {
        let folder = process::root().join(FIGURES);
        if folder.exists() {
            fs::remove_dir_all(&folder).with_context(|| format!("cannot empty {}", folder.display()))?;
        }
        report.layer("physics", |filter| {
            let words =
                ["test", "--release", "--package", "splashdown", "--test", "physics", "--", "--show-output"];
            let mut command = process::cargo(words);
            // One case at a time, so that wall times are comparable.
            command.args(["--test-threads", "1"]).args(&cases);
            let level = if has("--quick") { "quick" } else { "1" };
            command.env("SPLASHDOWN_FULL", level).env("SPLASHDOWN_FIGURES", &folder);
            for (name, value) in [("VARIANT", variant), ("ACROSS", across), ("DEVICE", device)] {
                if let Some(value) = value {
                    command.env(format!("SPLASHDOWN_{name}"), value);
                }
            }
            // Without a limit: a single case takes long at full resolution.
            let outcome = layers::tests(&mut command, filter, None)?;
            if outcome == Outcome::Passed && filter.passed == 0 {
                let names: Vec<&str> = cases.iter().map(|case| case.as_str()).collect();
                bail!(
                    "no case has {} in its name: `cargo xtask validate` runs all of them",
                    names.join(" or ")
                );
            }
            Ok(outcome)
        });
    }
    if let Some(variant) = variant
        && !record::has_variant(&process::root().join(FIGURES), variant)?
    {
        bail!("no case has the variant {variant}: the names are the columns of {PAGE}, for example dfsph");
    }
    record::merge(&process::root().join(FIGURES), &process::root().join(RECORDS))?;
    write_page(process::root())?;
    say(format!("Written: {PAGE}, and the tables of {REPORT}. `cargo xtask guide` builds them as HTML."));
    if has("--page") { Ok(()) } else { report.close() }
}

/// Writes the page and its plots from the committed figures.
fn write_page(root: &Path) -> Result<()> {
    let cases = record::read(&root.join(RECORDS))?;
    let plots = root.join("docs").join(PLOTS);
    if plots.exists() {
        fs::remove_dir_all(&plots).with_context(|| format!("cannot empty {}", plots.display()))?;
    }
    fs::create_dir_all(&plots)?;
    let (text, charts) = page::write(&cases, PLOTS)?;
    for (name, svg) in charts {
        fs::write(plots.join(&name), svg).with_context(|| format!("cannot write {name}"))?;
    }
    fs::write(root.join(PAGE), text).with_context(|| format!("cannot write {PAGE}"))?;
    let report = tables::write(&read(root, REPORT)?, &read(root, TABLES)?, &cases)?;
    fs::write(root.join(REPORT), report).with_context(|| format!("cannot write {REPORT}"))
}

/// A text of the repository, with line feeds only.
fn read(root: &Path, path: &str) -> Result<String> {
    let text = fs::read_to_string(root.join(path)).with_context(|| format!("cannot read {path}"))?;
    Ok(text.replace("\r\n", "\n"))
}

#[cfg(test)]
mod tests {
    use super::{PAGE, PLOTS, RECORDS, REPORT, TABLES, page, read, record, tables};
    use crate::process::root;

    #[test]
    fn the_committed_page_shows_the_committed_figures() {
        let (text, charts) = page::write(&record::read(&root().join(RECORDS)).unwrap(), PLOTS).unwrap();
        let committed = std::fs::read_to_string(root().join(PAGE)).unwrap().replace("\r\n", "\n");
        assert!(committed == text, "{PAGE} is out of date: run `cargo xtask validate --page`");
        for (name, _) in charts {
            assert!(root().join("docs").join(PLOTS).join(&name).exists(), "{name} is missing");
        }
    }

    #[test]
    fn the_tables_of_the_report_show_the_committed_figures() {
        let cases = record::read(&root().join(RECORDS)).unwrap();
        let report = read(root(), REPORT).unwrap();
        let written = tables::write(&report, &read(root(), TABLES).unwrap(), &cases).unwrap();
        for (committed, expected) in report.lines().zip(written.lines()) {
            assert_eq!(committed, expected, "{REPORT} is out of date: run `cargo xtask validate --page`");
        }
        assert_eq!(report.len(), written.len());
    }
}
