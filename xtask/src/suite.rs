//! The second command of the README, and all of the continuous integration.

use anyhow::{Result, bail};

use crate::layers::{Outcome, Report, filtered, succeeds};
use crate::process::{cargo, command, say};
use crate::{guide, page, python, setup};

/// Systems that are checked without being there.
const OTHER_SYSTEMS: [(&str, &str); 2] =
    [("Windows", "x86_64-pc-windows-msvc"), ("macOS", "aarch64-apple-darwin")];

/// The word `test`.
pub fn run(arguments: &[String]) -> Result<()> {
    let fast = match arguments {
        [] => false,
        [flag] if flag == "--fast" => true,
        other => bail!("test takes --fast or nothing, got {}", other.join(" ")),
    };
    let mut report = Report::default();
    report.layer("requirements", |_| {
        setup::ensure_requirements()?;
        setup::ensure_screen();
        python::ensure();
        Ok(Outcome::Passed)
    });
    report.layer("format", |_| succeeds(&mut cargo(["fmt", "--all", "--", "--check"])));
    report.layer("lints", |_| {
        succeeds(&mut cargo([
            "clippy",
            "--workspace",
            "--all-targets",
            "--quiet",
            "--",
            "--deny",
            "warnings",
        ]))
    });
    report.layer("tests", |filter| {
        filtered(&mut cargo(["test", "--workspace", "--no-fail-fast", "--", "--show-output"]), filter)
    });
    if fast {
        say("\n--fast: documentation and other systems were left out.");
    } else {
        report.layer("documentation", |_| {
            let mut doc = cargo(["doc", "--workspace", "--exclude", "xtask", "--no-deps", "--quiet"]);
            succeeds(doc.env("RUSTDOCFLAGS", "--deny warnings"))
        });
        report.layer("guide", |_| guide::test());
        report.layer("web page", |_| page::test());
        for (name, target) in OTHER_SYSTEMS {
            report.layer(&format!("{name} ({target})"), |_| check_for(target));
        }
    }
    report.close()
}

/// Type-checks everything for another system; skipped only where its standard library cannot be had.
fn check_for(target: &str) -> Result<Outcome> {
    let added = command("rustup").args(["target", "add", target]).output();
    match added {
        Err(error) => return Ok(Outcome::Skipped(format!("cannot start rustup ({error})"))),
        Ok(output) if !output.status.success() => {
            let stderr = String::from_utf8_lossy(&output.stderr);
            let reason = stderr.lines().last().unwrap_or("no reason given").to_owned();
            return Ok(Outcome::Skipped(format!("rustup cannot add it: {reason}")));
        }
        Ok(_) => {}
    }
    succeeds(&mut cargo(["check", "--workspace", "--quiet", "--target", target]))
}
