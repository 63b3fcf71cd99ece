//! The console output of a run: text and a progress bar for people, JSON lines for programs.

use std::collections::BTreeSet;
use std::path::Path;
use std::time::Duration;

use splashdown::run::{Progress, ProgressFn, Started};
use splashdown_run::{CompleteFrame, Reporter, RunEnd, RunOutcome};

use crate::console::{self, Verbosity};
use crate::exit::{Exit, Failure};
use crate::lines::Line;
use crate::progress::Bar;
use crate::{human, summary};

/// Reports a run on the console.
#[derive(Debug)]
pub struct ConsoleReporter {
    json: bool,
    verbosity: Verbosity,
    bar: Bar,
    last_progress: Option<Duration>,
}

impl ConsoleReporter {
    /// A reporter that has printed nothing yet.
    pub fn new(json: bool, verbosity: Verbosity) -> Self {
        Self { json, verbosity, bar: Bar::new(verbosity, json), last_progress: None }
    }

    /// Prints the result of the run.
    ///
    /// # Errors
    /// The failure of the run.
    pub fn close(&self, outcome: RunOutcome, timing: bool) -> Result<Exit, Failure> {
        self.bar.clear();
        let results = partial_results(&outcome);
        let RunOutcome { end, folder, last_frame, files, films, picture_timings, .. } = outcome;
        // The files that belong to no single frame.
        let whole = files.iter().map(|file| &file.path).filter(|path| !is_of_frame(path, folder.root()));
        let whole = whole.chain(films.iter().map(|film| &film.path)).cloned().chain([folder.report()]);
        let whole: BTreeSet<_> = whole.collect();
        let closing: Vec<String> = whole.iter().map(|path| path.display().to_string()).collect();
        match end {
            RunEnd::Finished(numbers) => {
                let triangles = last_frame.as_ref().and_then(|frame| frame.summary.triangles);
                self.line(&Line::finished(&numbers, triangles, closing));
                if timing {
                    self.print(&format!("\n{}", summary::passes(&numbers.timings, numbers.steps)));
                    if picture_timings.pictures > 0 && !picture_timings.passes.passes.is_empty() {
                        self.print(&format!("\n{}", summary::picture_passes(&picture_timings)));
                    }
                }
                self.print(&format!("\nFinished.\n{}", summary::numbers(&numbers)));
                self.print(&format!("\n{}", summary::files(folder.root(), &files, &films)));
                Ok(Exit::Success)
            }
            RunEnd::Failed(error) => {
                self.print_note(&results);
                Err(error.into())
            }
            _ => {
                self.line(&Line::interrupted(last_frame.as_ref(), closing));
                self.print(&format!("\nStopped. {results}"));
                self.print(&summary::files(folder.root(), &files, &films));
                Ok(Exit::Interrupted)
            }
        }
    }

    /// Information on stderr, unless quiet.
    fn print_note(&self, text: &str) {
        if self.verbosity > Verbosity::Quiet {
            self.bar.note(text);
        }
    }

    /// Results on stdout, unless quiet or in JSON mode.
    fn print(&self, text: &str) {
        if !self.json && self.verbosity > Verbosity::Quiet {
            console::print(text);
        }
    }

    fn line(&self, line: &Line) {
        if self.json {
            self.bar.suspend(|| console::print_json(line));
        }
    }
}

/// Whether a file belongs to one frame or checkpoint: `mesh/surface_0012.ply`. Those in the run's folder itself, such as
/// `scene_0006.usdc` of a run that begins there, and the tables of bodies and probes belong to all.
fn is_of_frame(path: &Path, root: &Path) -> bool {
    let folder = path.parent().unwrap_or(root);
    if folder == root || folder == root.join("bodies") || folder == root.join("probes") {
        return false;
    }
    let stem = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
    stem.rsplit_once('_').is_some_and(|(_, number)| number.bytes().all(|digit| digit.is_ascii_digit()))
}

impl Reporter for ConsoleReporter {
    fn note(&mut self, text: &str) {
        self.print_note(text);
    }

    fn warning(&mut self, text: &str) {
        // Warnings of a scene already start with this word.
        let text = text.trim_start_matches("warning: ");
        self.print_note(&format!("warning: {text}"));
        self.line(&Line::warning(text));
    }

    fn started(&mut self, started: &Started) {
        self.print_note(&format!(
            "{}, {}, {} of memory, on {}",
            human::counted(started.particles.into(), "particle"),
            human::counted(started.frames.into(), "frame"),
            human::bytes(started.memory),
            started.device
        ));
        if started.time > 0.0 {
            let (frame, time) = (started.first_frame, started.time);
            self.print_note(&format!("Resuming after frame {frame}, at {time:.4} s."));
        }
        self.line(&Line::started(started));
    }

    /// Updates the bar every time, and prints a line once a second.
    fn progress(&mut self, progress: &Progress) {
        self.bar.update(progress);
        if self.last_progress.is_none_or(|last| progress.wall.saturating_sub(last) >= Duration::from_secs(1))
        {
            self.last_progress = Some(progress.wall);
            self.line(&Line::progress(progress));
        }
    }

    fn frame_complete(&mut self, frame: &CompleteFrame) {
        self.line(&Line::frame(frame));
    }

    fn waiting(&mut self, what: &str) {
        self.bar.waiting(what);
    }

    fn preparation(&self) -> Option<ProgressFn> {
        Some(self.bar.preparation())
    }
}

/// Describes the frames of an incomplete run, and how to resume it.
fn partial_results(outcome: &RunOutcome) -> String {
    let folder = outcome.folder.root().display();
    let text = match outcome.complete_frames {
        0 => "No frame was completed.".to_owned(),
        count => {
            let last = outcome.last_frame.as_ref().map_or(count as u32 - 1, |frame| frame.summary.index);
            let first = u64::from(last) + 1 - count as u64;
            format!("{count} frames ({first} to {last}) are complete in {folder}.")
        }
    };
    match outcome.resumable {
        true => format!("{text}\nResume with: splashdown run --resume {folder}"),
        false => text,
    }
}
