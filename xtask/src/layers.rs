//! The layers of `cargo xtask test`: each layer runs even if an earlier one failed, and a summary reports all of them.

use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};

use crate::kill;
use crate::process::{self, say};
use crate::test_output::{Filter, MARK};
use crate::watch::{SILENCE, Watch};

/// How a layer ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// It succeeded.
    Passed,
    /// It failed; the text states the reason.
    Failed(String),
    /// It could not run; the text states the reason.
    Skipped(String),
}

/// The outcomes of all layers.
#[derive(Debug, Default)]
pub struct Report {
    layers: Vec<(String, Outcome, Duration)>,
    filter: Filter,
    /// Layers without this text in their name are left out.
    only: Option<String>,
}

impl Report {
    /// A report of the layers whose name contains this text.
    pub fn only(text: Option<&str>) -> Self {
        Self { only: text.map(str::to_owned), ..Self::default() }
    }

    /// Runs one layer, independent of earlier outcomes, and records its wall time.
    pub fn layer(&mut self, name: &str, body: impl FnOnce(&mut Filter) -> Result<Outcome>) {
        if self.only.as_ref().is_some_and(|text| !name.contains(text.as_str())) {
            return;
        }
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
        if let (true, Some(text)) = (self.layers.is_empty(), &self.only) {
            bail!("no layer has \"{text}\" in its name");
        }
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

/// Runs a command; its exit status is the outcome. It is killed if it does not end within [`SILENCE`].
pub fn succeeds(command: &mut Command) -> Result<Outcome> {
    let words = process::line(command);
    let mut child = command.spawn().with_context(|| format!("cannot start `{words}`"))?;
    let start = Instant::now();
    loop {
        match child.try_wait()? {
            Some(status) if status.success() => return Ok(Outcome::Passed),
            Some(status) => return Ok(Outcome::Failed(format!("`{words}` failed ({status})"))),
            None if start.elapsed() > SILENCE => {
                kill::tree(child.id(), true);
                child.wait()?;
                let minutes = SILENCE.as_secs() / 60;
                return Ok(Outcome::Failed(format!("`{words}` was killed after {minutes} minutes")));
            }
            None => thread::sleep(Duration::from_millis(50)),
        }
    }
}

/// Runs tests. Their output goes through the filter. With a watch, hung tests are killed and named.
pub fn tests(command: &mut Command, filter: &mut Filter, mut watch: Option<Watch>) -> Result<Outcome> {
    let words = process::line(command);
    let mut child = command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .with_context(|| format!("cannot start `{words}`"))?;
    let stderr = child.stderr.take().context("the child has no stderr")?;
    let stdout = child.stdout.take().context("the child has no stdout")?;
    let (sender, lines) = mpsc::channel();
    // One thread per pipe, so that neither fills up.
    read(stdout, Source::Harness, sender.clone())?;
    read(stderr, Source::Cargo, sender)?;
    let mut hung = Vec::new();
    loop {
        match lines.recv_timeout(Duration::from_secs(1)) {
            Ok((source, line)) => {
                if let Some(watch) = &mut watch {
                    watch.see(&line, Instant::now());
                }
                // Cargo's own progress is always shown.
                if source == Source::Cargo {
                    if line.contains(MARK) {
                        filter.see(&line);
                    }
                    eprintln!("{line}");
                } else if filter.see(&line) {
                    say(&line);
                }
            }
            Err(RecvTimeoutError::Timeout) => {
                if let Some(watch) = &mut watch
                    && let Some(reason) = watch.hung(Instant::now())
                {
                    say(format!("KILLED: {reason}"));
                    kill::tree(child.id(), false);
                    watch.killed(Instant::now());
                    hung.push(reason);
                }
            }
            Err(RecvTimeoutError::Disconnected) => break,
        }
    }
    let status = child.wait()?;
    if !hung.is_empty() {
        return Ok(Outcome::Failed(format!("killed: {}", hung.join("; "))));
    }
    if status.success() { Ok(Outcome::Passed) } else { Ok(Outcome::Failed(format!("`{words}` ({status})"))) }
}

/// Which pipe a line came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Source {
    Cargo,
    Harness,
}

/// Sends the lines of a pipe from a separate thread.
fn read(
    pipe: impl Read + Send + 'static,
    source: Source,
    lines: mpsc::Sender<(Source, String)>,
) -> Result<()> {
    thread::Builder::new().name(format!("{source:?}")).spawn(move || {
        for line in BufReader::new(pipe).split(b'\n').map_while(std::io::Result::ok) {
            let line = String::from_utf8_lossy(&line).trim_end_matches('\r').to_owned();
            if lines.send((source, line)).is_err() {
                break;
            }
        }
    })?;
    Ok(())
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use std::time::{Duration, Instant};

    use super::{Outcome, succeeds, tests};
    use crate::process::command;
    use crate::test_output::Filter;
    use crate::watch::Watch;

    #[test]
    fn a_hung_test_is_killed_and_named_and_later_binaries_run() {
        // What Cargo and two binaries print; the first one hangs.
        let script = "echo '     Running tests/a.rs' >&2; echo 'test good ... ok'; sleep 0.5; \
                      sh -c \"echo 'test deep::stuck has been running for over 60 seconds'; sleep 100\"; \
                      : > \"$0\"; exit 101";
        let later = std::env::temp_dir().join(format!("splashdown-later-{}", std::process::id()));
        let watch = Watch::new(Instant::now()).with_limit(Duration::from_secs(60));
        let mut filter = Filter::default();
        let start = Instant::now();
        let outcome =
            tests(command("sh").args(["-c", script]).arg(&later), &mut filter, Some(watch)).unwrap();
        assert!(start.elapsed() < Duration::from_secs(50));
        let Outcome::Failed(reason) = outcome else { panic!("{outcome:?}") };
        assert!(reason.contains("deep::stuck in tests/a.rs"), "{reason}");
        std::fs::remove_file(&later).expect("the script continues after the kill");
    }

    #[test]
    fn a_failing_command_is_a_failure() {
        let outcome = succeeds(command("sh").args(["-c", "exit 3"])).unwrap();
        assert!(matches!(outcome, Outcome::Failed(reason) if reason.contains('3')));
        assert_eq!(succeeds(command("sh").args(["-c", "true"])).unwrap(), Outcome::Passed);
    }
}
