//! `cargo xtask bench --peers`: runs the same cases with Splashdown, SPlisHSPlasH and splashsurf, alternately, on one
//! machine with the same number of threads. The other programs are Python wheels.

mod cases;
mod numbers;
mod simulated;
mod steps;
mod surface;
mod table;

use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, Result, bail, ensure};

use crate::process::{self, root, say, target};
use crate::report::Page;
use crate::{python, report, setup};

/// Default number of alternating measurements of each program; the median is reported.
const ROUNDS: usize = 3;

/// The programs and the settings of a comparison.
struct Sides {
    /// The `splashdown` binary.
    ours: PathBuf,
    /// The Python interpreter whose environment contains the other programs.
    python: PathBuf,
    /// Folder of scenes and meshes.
    folder: PathBuf,
    threads: usize,
    rounds: usize,
    quick: bool,
}

/// The options of `bench --peers`.
#[derive(Debug, Default, PartialEq)]
struct Options {
    quick: bool,
    /// Number of alternating measurements.
    rounds: Option<usize>,
    /// Particles for the surface reconstruction, and their spacing.
    particles: Option<(PathBuf, f64)>,
}

impl Options {
    fn parse(arguments: &[String]) -> Result<Self> {
        let mut options = Self::default();
        let mut words = arguments.iter();
        while let Some(word) = words.next() {
            match word.as_str() {
                "--quick" => options.quick = true,
                "--rounds" => {
                    let rounds = words.next().and_then(|text| text.parse().ok()).filter(|rounds| *rounds > 0);
                    options.rounds = Some(rounds.context("--rounds takes a number from 1 on")?);
                }
                "--particles" => {
                    let usage = "--particles takes a file (.npy, .npz) and the particle spacing";
                    let path = words.next().context(usage)?;
                    let spacing = words.next().and_then(|text| text.parse().ok()).context(usage)?;
                    options.particles = Some((path.into(), spacing));
                }
                other => bail!(
                    "bench --peers takes --quick, --rounds N and --particles FILE SPACING, got {other}; `cargo xtask help`"
                ),
            }
        }
        Ok(options)
    }
}

/// Measures and writes `docs/peers.md`; with `--quick`, a trial run, the results are only printed.
pub fn run(arguments: &[String]) -> Result<()> {
    let options = Options::parse(arguments)?;
    let ours = process::build_release()?;
    setup::ensure_gl();
    let folder = target().join("peers");
    let python = python::environment(None, &folder, &root().join("xtask/peers/requirements.txt"))
        .context("cannot install the other programs; check the network connection")?;
    let sides = Sides {
        ours,
        python,
        folder: folder.join("work"),
        threads: report::threads(),
        rounds: options.rounds.unwrap_or(if options.quick { 1 } else { ROUNDS }),
        quick: options.quick,
    };
    std::fs::create_dir_all(&sides.folder)?;
    let mut page = Page::new(
        "Comparison with other programs",
        &format!("cargo xtask bench --peers {}", arguments.join(" ")),
        &sides.ours,
    )?;
    let rounds = match sides.rounds {
        1 => "Each program runs once".to_owned(),
        rounds => format!("The programs run in turn, {rounds} times each, and the figures are medians"),
    };
    page.add(&format!(
        "{rounds}, in separate processes with {} threads. The other programs are the Python wheels of `xtask/peers/requirements.txt`.",
        sides.threads
    ));
    simulated::compare(&sides, &mut page)?;
    steps::compare(&sides, &mut page)?;
    surface::compare(&sides, options.particles, &mut page)?;
    if options.quick {
        say("\n--quick: docs/peers.md is unchanged.");
        return Ok(());
    }
    page.write("docs/peers.md")
}

/// Runs a command and returns the last line that it prints, which is its result.
fn answer(command: &mut Command) -> Result<String> {
    let words = process::line(command);
    let output = command.output().with_context(|| format!("cannot start `{words}`"))?;
    let text = String::from_utf8_lossy(&output.stdout);
    ensure!(
        output.status.success(),
        "`{words}` failed ({}):\n{text}{}",
        output.status,
        String::from_utf8_lossy(&output.stderr)
    );
    let line = text.lines().rev().find(|line| line.starts_with('{'));
    Ok(line.with_context(|| format!("`{words}` printed no result:\n{text}"))?.to_owned())
}

#[cfg(test)]
mod tests {
    use super::Options;

    fn parse(words: &[&str]) -> anyhow::Result<Options> {
        Options::parse(&words.iter().map(|&word| word.to_owned()).collect::<Vec<_>>())
    }

    #[test]
    fn unknown_and_incomplete_options_are_rejected() {
        assert_eq!(parse(&[]).unwrap(), Options::default());
        let options = parse(&["--particles", "a.npy", "0.05", "--quick"]).unwrap();
        assert_eq!(options, Options { quick: true, rounds: None, particles: Some(("a.npy".into(), 0.05)) });
        assert_eq!(parse(&["--rounds", "2"]).unwrap().rounds, Some(2));
        for wrong in [
            &["--rounds", "0"][..],
            &["--particles", "a.npy"],
            &["--particles", "a.npy", "wide"],
            &["--fast"],
        ] {
            assert!(parse(wrong).is_err(), "{wrong:?}");
        }
    }
}
