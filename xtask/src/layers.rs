//! The layers of `cargo xtask test`: each one runs even if an earlier one failed, and all are reported at the end.

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, Result};

use crate::process::{self, say};
use crate::test_output::{Filter, MARK};

/// How a layer ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// All well.
    Passed,
    /// Something is wrong; the text says what.
    Failed(String),
    /// It could not run; the text says why.
    Skipped(String),
}

/// What came of all layers.
#[derive(Debug, Default)]
pub struct Report {
    layers: Vec<(String, Outcome, Duration)>,
    filter: Filter,
}

impl Report {
    /// Runs one layer, whatever came before, and notes its time.
    pub fn layer(&mut self, name: &str, body: impl FnOnce(&mut Filter) -> Result<Outcome>) {
        say(format!("\n=== {name}"));
        let start = Instant::now();
        let outcome = body(&mut self.filter).unwrap_or_else(|error| Outcome::Failed(format!("{error:#}")));
        match &outcome {
            Outcome::Passed => {}
            Outcome::Failed(reason) => say(format!("FAILED: {name}: {reason}")),
            Outcome::Skipped(reason) => say(format!("{MARK} {name}: {reason}")),
        }
        self.layers.push((name.to_owned(), outcome, start.elapsed()));
    }

    /// Prints the closing summary.
    ///
    /// # Errors
    /// If any layer failed.
    pub fn close(self) -> Result<()> {
        say("\n=== Summary");
        for (name, outcome, time) in &self.layers {
            let word = match outcome {
                Outcome::Passed => "ok",
                Outcome::Failed(_) => "FAILED",
                Outcome::Skipped(_) => "SKIPPED",
            };
            say(format!("{word:8} {:7.1} s  {name}", time.as_secs_f64()));
        }
        say(format!("{} tests passed, {} failed", self.filter.passed, self.filter.failed));
        let layers = self.layers.iter().filter_map(|(name, outcome, _)| match outcome {
            Outcome::Skipped(reason) => Some((format!("{MARK} {name}: {reason}"), 1)),
            _ => None,
        });
        let skipped: Vec<(String, usize)> = self.filter.skipped.into_iter().chain(layers).collect();
        if !skipped.is_empty() {
            let count: usize = skipped.iter().map(|(_, count)| count).sum();
            say(format!("{count} skipped:"));
            for (reason, count) in skipped {
                say(format!("  {count} x {reason}"));
            }
        }
        let failed =
            self.layers.iter().filter(|(_, outcome, _)| matches!(outcome, Outcome::Failed(_))).count();
        match failed {
            0 => Ok(()),
            1 => Err(anyhow::anyhow!("one layer failed")),
            n => Err(anyhow::anyhow!("{n} layers failed")),
        }
    }
}

/// A command whose success is the outcome.
pub fn succeeds(command: &mut Command) -> Result<Outcome> {
    process::run(command)?;
    Ok(Outcome::Passed)
}

/// A test run whose output goes through the filter.
pub fn filtered(command: &mut Command, filter: &mut Filter) -> Result<Outcome> {
    let words = process::line(command);
    let mut child = command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .with_context(|| format!("cannot start `{words}`"))?;
    let stderr = child.stderr.take().context("the child has no stderr")?;
    let stdout = child.stdout.take().context("the child has no stdout")?;
    // Cargo's own progress comes on stderr; a thread of its own, so that neither pipe fills up.
    let echo = thread::Builder::new().name("stderr".to_owned()).spawn(move || {
        let mut lines = Vec::new();
        for line in BufReader::new(stderr).lines().map_while(std::io::Result::ok) {
            eprintln!("{line}");
            if line.contains(MARK) {
                lines.push(line);
            }
        }
        lines
    })?;
    for line in BufReader::new(stdout).split(b'\n').map_while(std::io::Result::ok) {
        let line = String::from_utf8_lossy(&line);
        if filter.see(line.trim_end_matches('\r')) {
            say(&line);
        }
    }
    for line in echo.join().unwrap_or_default() {
        filter.see(&line);
    }
    let status = child.wait()?;
    if status.success() { Ok(Outcome::Passed) } else { Ok(Outcome::Failed(format!("`{words}` ({status})"))) }
}
