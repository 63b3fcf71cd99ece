//! What a run says: words and a bar for people, lines for programs, `run.json` for later, all from the same events.

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use splashdown::{Listener, Progress, Started, Summary};
use splashdown_io::WrittenFile;

use crate::console::{self, Verbosity};
use crate::exit::{Exit, Failure};
use crate::files::CompleteFrame;
use crate::layout::Layout;
use crate::lines::Line;
use crate::progress::Bar;
use crate::report::Report;
use crate::{human, summary};

/// The voice of a run.
#[derive(Debug)]
pub struct Teller {
    json: bool,
    verbosity: Verbosity,
    bar: Bar,
    report: Report,
    last_progress: Option<Duration>,
    last: Option<CompleteFrame>,
    summary: Option<Summary>,
    can_go_on: bool,
}

impl Teller {
    /// Says nothing yet.
    pub fn new(json: bool, verbosity: Verbosity, report: Report) -> Self {
        Self {
            json,
            verbosity,
            bar: Bar::new(verbosity, json),
            report,
            last_progress: None,
            last: None,
            summary: None,
            can_go_on: false,
        }
    }

    /// The run goes on after this many frames that are complete.
    pub fn resumed(&mut self, frames: usize) {
        self.report.complete_frames = frames;
    }

    /// The index of the last frame whose files are complete.
    pub fn last_complete(&self) -> Option<u32> {
        self.last.as_ref().map(|frame| frame.account.index)
    }

    /// A remark, unless quiet.
    pub fn note(&self, text: &str) {
        if self.verbosity > Verbosity::Quiet {
            self.bar.note(text);
        }
    }

    /// Something the user should know.
    pub fn warn(&self, message: &str) {
        let message = message.trim_start_matches("warning: ");
        self.note(&format!("warning: {message}"));
        self.line(&Line::warning(message));
    }

    /// The run begins.
    pub fn started(&mut self, started: &Started) {
        self.note(&format!(
            "{}, {}, {} of memory, on {}",
            human::counted(started.particles.into(), "particle"),
            human::counted(started.frames.into(), "frame"),
            human::bytes(started.memory),
            started.device
        ));
        if started.time > 0.0 {
            self.note(&format!("Going on after frame {}, at {:.4} s.", started.first_frame, started.time));
        }
        self.report.device = Some(started.device.clone());
        self.line(&Line::started(started));
    }

    /// Shows what takes time before the run begins.
    pub fn listener(&self) -> Listener {
        self.bar.listener()
    }

    /// Where it is. The bar follows every time, a line comes once a second.
    pub fn progress(&mut self, progress: &Progress) {
        self.bar.update(progress);
        if self.last_progress.is_none_or(|last| progress.wall.saturating_sub(last) >= Duration::from_secs(1))
        {
            self.last_progress = Some(progress.wall);
            self.line(&Line::progress(progress));
        }
    }

    /// Frames whose files have become complete.
    pub fn complete(&mut self, frames: Vec<CompleteFrame>) {
        for frame in frames {
            self.report.complete_frames += 1;
            self.report.end(&frame.account.stats);
            self.line(&Line::frame(&frame));
            self.last = Some(frame);
        }
    }

    /// The simulation is done.
    pub fn finished(&mut self, summary: Summary) {
        self.report.summary(&summary);
        self.summary = Some(summary);
    }

    /// Whether there is a checkpoint to go on from.
    pub fn can_go_on(&mut self, can: bool) {
        self.can_go_on = can;
    }

    /// What is being waited for.
    pub fn waiting(&self, what: &str) {
        self.bar.waiting(what);
    }

    /// Writes the report and says the closing words.
    ///
    /// # Errors
    /// The failure given, or that of writing the report.
    pub fn close(
        mut self,
        layout: &Layout,
        files: &[WrittenFile],
        films: &[(PathBuf, u64)],
        failure: Option<Failure>,
        timing: bool,
    ) -> Result<ExitCode, Failure> {
        self.bar.clear();
        self.report.status = match (&failure, &self.summary) {
            (Some(_), _) => "failed",
            (None, Some(_)) => "finished",
            (None, None) => "interrupted",
        };
        self.report.error = failure.as_ref().map(ToString::to_string);
        self.report.files = files.len() + films.len();
        self.report.bytes = files.iter().map(|file| file.bytes).chain(films.iter().map(|film| film.1)).sum();
        let written = self.report.write(layout);
        if let Some(failure) = failure {
            self.note(&self.what_is_left(layout));
            return Err(failure);
        }
        written?;
        let closing = [layout.report()];
        let names = films.iter().map(|(path, _)| path).chain(&closing).map(|path| path.display().to_string());
        let names: Vec<String> = names.collect();
        match &self.summary {
            Some(numbers) => {
                let triangles = self.last.as_ref().and_then(|frame| frame.account.triangles);
                self.line(&Line::finished(numbers, triangles, names));
                if timing {
                    self.say(&format!("\n{}", summary::passes(&numbers.timings, numbers.steps)));
                }
                self.say(&format!("\nFinished.\n{}", summary::numbers(numbers)));
                self.say(&format!("\n{}", summary::files(layout.root(), files, films)));
                Ok(ExitCode::SUCCESS)
            }
            None => {
                self.line(&Line::interrupted(self.last.as_ref(), names));
                self.say(&format!("\nStopped. {}", self.what_is_left(layout)));
                self.say(&summary::files(layout.root(), files, films));
                Ok(ExitCode::from(Exit::Interrupted as u8))
            }
        }
    }

    fn what_is_left(&self, layout: &Layout) -> String {
        let left = match self.report.complete_frames {
            0 => "No frame was completed.".to_owned(),
            count => {
                let last = self.last_complete().unwrap_or(count as u32 - 1);
                let first = u64::from(last) + 1 - count as u64;
                format!("{count} frames ({first} to {last}) are complete in {}.", layout.root().display())
            }
        };
        match self.can_go_on {
            true => format!("{left}\nGo on with: splashdown run --resume {}", layout.root().display()),
            false => left,
        }
    }

    /// Results on stdout, unless a program reads there or nobody wants to know.
    fn say(&self, text: &str) {
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
