//! The result of a run.

use splashdown::run::Summary;
use splashdown_gpu::Timings;
use splashdown_io::WrittenFile;

use crate::{CompleteFrame, RunError, RunFolder};

/// The times of the passes of pictures on the device.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct PictureTimings {
    /// Number of pictures.
    pub pictures: u64,
    /// The sums over all of them.
    pub passes: Timings,
}

/// How a run ended.
#[derive(Debug)]
#[non_exhaustive]
pub enum RunEnd {
    /// All frames were computed.
    Finished(Box<Summary>),
    /// It was stopped by request.
    Interrupted,
    /// It failed. Frames already written are complete.
    Failed(RunError),
}

/// The result of a run and its files.
#[derive(Debug)]
#[non_exhaustive]
#[must_use]
pub struct RunOutcome {
    /// How it ended.
    pub end: RunEnd,
    /// Where the files are.
    pub folder: RunFolder,
    /// Number of frames with complete files, including the initial one and those before a resume.
    pub complete_frames: usize,
    /// The last frame that this run completed.
    pub last_frame: Option<CompleteFrame>,
    /// The files of all frames, checkpoints and probes, including those before a resume.
    pub files: Vec<WrittenFile>,
    /// The films.
    pub films: Vec<WrittenFile>,
    /// The times of the passes of the pictures, if they were measured.
    pub picture_timings: PictureTimings,
    /// Whether the folder contains a checkpoint to resume from.
    pub resumable: bool,
}
