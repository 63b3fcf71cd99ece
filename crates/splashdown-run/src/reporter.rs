//! The interface by which a run reports to its caller and is stopped.

use splashdown::run::{Progress, ProgressFn, Started};

use crate::CompleteFrame;

/// Receives the messages and the progress of a run. Every method has an empty default, so `()` is a silent reporter.
pub trait Reporter {
    /// Information for people.
    fn note(&mut self, text: &str) {
        let _ = text;
    }

    /// A problem that does not stop the run.
    fn warning(&mut self, text: &str) {
        let _ = text;
    }

    /// The simulation starts.
    fn started(&mut self, started: &Started) {
        let _ = started;
    }

    /// The simulation has advanced, several times a second.
    fn progress(&mut self, progress: &Progress) {
        let _ = progress;
    }

    /// All files of a frame are complete.
    fn frame_complete(&mut self, frame: &CompleteFrame) {
        let _ = frame;
    }

    /// The run waits for this.
    fn waiting(&mut self, what: &str) {
        let _ = what;
    }

    /// Called with the progress of what precedes the first step, such as distance fields and the initial packing.
    fn preparation(&self) -> Option<ProgressFn> {
        None
    }
}

impl Reporter for () {}

/// A request to stop a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// Continue.
    No,
    /// Complete the current frame, write a checkpoint, then stop.
    AfterFrame,
    /// Stop at once. Queued files are still written.
    Now,
}
