//! `cargo xtask test`, which continuous integration also runs.

use std::time::Instant;

use anyhow::{Result, bail};

use crate::layers::{self, Outcome, Report, succeeds};
use crate::process::{self, cargo, command, say};
use crate::test_output::Filter;
use crate::watch::Watch;
use crate::{api, guide, page, python, setup, shaders, storms, supply, wheel};

/// Systems for which the code is type-checked without running it.
const OTHER_SYSTEMS: [(&str, &str); 2] =
    [("Windows", "x86_64-pc-windows-msvc"), ("macOS", "aarch64-apple-darwin")];

/// Its build needs Python, so it has a layer of its own.
const PYTHON_PACKAGE: &str = "splashdown-py";

/// The extent of a test run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Extent {
    /// Format, lints, tests, random scenes and shaders.
    Fast,
    /// Also documentation, the web page and other systems, with quick builds.
    Usual,
    /// Also Blender, the optimized page, the tests of the command line without features, and the Python package.
    Integration,
    /// Also all code for other systems, and the public API even if its tool has to be installed.
    All,
}

/// The command `test`.
pub fn run(arguments: &[String]) -> Result<()> {
    let (arguments, only) = match arguments {
        [rest @ .., flag, layer] if flag == "--only" => (rest, Some(layer.as_str())),
        all => (all, None),
    };
    let extent = match arguments {
        [] if only.is_some() => Extent::All,
        [] if process::is_ci() => Extent::Integration,
        [] => Extent::Usual,
        [flag] if flag == "--fast" => Extent::Fast,
        [flag] if flag == "--all" => Extent::All,
        other => bail!("test takes --fast, --all, --only LAYER or nothing, got {}", other.join(" ")),
    };
    setup::ensure_requirements()?;
    setup::ensure_screen();
    python::ensure(extent >= Extent::Integration);
    let mut report = Report::only(only);
    report.layer("format", |_| succeeds(&mut cargo(["fmt", "--all", "--", "--check"])));
    report.layer("lints", |_| {
        succeeds(&mut cargo([
            "clippy",
            "--workspace",
            "--exclude",
            PYTHON_PACKAGE,
            "--all-targets",
            "--quiet",
            "--",
            "--deny",
            "warnings",
        ]))
    });
    report.layer("tests", |filter| {
        let mut tests = cargo([
            "test",
            "--workspace",
            "--exclude",
            PYTHON_PACKAGE,
            "--no-fail-fast",
            "--",
            "--show-output",
        ]);
        layers::tests(&mut tests, filter, Some(Watch::new(Instant::now())))
    });
    process::discard("python");
    report.layer("random scenes", |_| storms::layer());
    report.layer("shaders", |_| shaders::layer());
    if extent == Extent::Fast {
        say("\n--fast: documentation, the web page and other systems were not checked.");
    } else {
        report.layer("documentation", |_| {
            let mut doc = cargo(["doc", "--workspace", "--exclude", "xtask", "--no-deps", "--quiet"]);
            doc.args(["--exclude", PYTHON_PACKAGE]);
            match succeeds(doc.env("RUSTDOCFLAGS", "--deny warnings"))? {
                Outcome::Passed => api::check_names(),
                failed => Ok(failed),
            }
        });
        report.layer("public API", |_| api::layer(extent == Extent::All));
        report.layer("dependencies", |_| supply::layer(true));
        report.layer("guide", |_| guide::test(extent >= Extent::Integration));
        report.layer("web page", |_| page::test(extent >= Extent::Integration));
        process::discard("wasm32-unknown-unknown");
        for (name, target) in OTHER_SYSTEMS {
            report.layer(&format!("{name} ({target})"), |_| check_for(target, extent == Extent::All));
            process::discard(target);
        }
        // Other features of the dependencies are needed, so that 40 crates are built again, in five minutes on two
        // cores.
        if extent >= Extent::Integration {
            report.layer("command line without features", without_features);
            report.layer("Python package", wheel::layer);
        }
    }
    report.close()
}

/// Tests the messages of the command line without Cargo features.
fn without_features(filter: &mut Filter) -> Result<Outcome> {
    let mut tests = cargo(["test", "--package", "splashdown-cli", "--no-default-features"]);
    tests.args(["--test", "without_features", "--", "--show-output"]);
    layers::tests(&mut tests, filter, Some(Watch::new(Instant::now())))
}

/// Type-checks the code for another system; skipped only if its standard library cannot be installed. By default this
/// covers the smallest command line, which also checks the build without features and has 40 % of the crates.
fn check_for(target: &str, all: bool) -> Result<Outcome> {
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
    let smallest = cargo_check(target, &["--package", "splashdown-cli", "--no-default-features"])?;
    if smallest != Outcome::Passed || !all {
        return Ok(smallest);
    }
    cargo_check(target, &["--workspace", "--exclude", PYTHON_PACKAGE])
}

fn cargo_check(target: &str, extent: &[&str]) -> Result<Outcome> {
    succeeds(cargo(["check", "--quiet", "--target", target]).args(extent))
}
