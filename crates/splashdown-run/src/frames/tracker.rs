//! Tracks which frames still wait for which files.

use std::collections::{HashSet, VecDeque};
use std::path::PathBuf;

use splashdown::scene::{Choice, Format};
use splashdown_io::{IoError, WrittenFile, pvd};

use super::CompleteFrame;
use crate::RunFolder;

/// Frames in the queue of the writer, and the ParaView index of those that are complete.
#[derive(Debug)]
pub struct Tracker {
    folder: RunFolder,
    /// Whether ParaView's index is written.
    indexed: bool,
    pending: VecDeque<CompleteFrame>,
    written: HashSet<PathBuf>,
    seen: usize,
    /// Times in s and file names.
    series: Vec<(f64, String)>,
}

impl Tracker {
    pub fn new(folder: RunFolder, indexed: bool) -> Self {
        Self {
            folder,
            indexed,
            pending: VecDeque::new(),
            written: HashSet::new(),
            seen: 0,
            series: Vec::new(),
        }
    }

    /// Adds the existing frames up to `last` to the index.
    pub fn add_existing(&mut self, last: u32, frame_rate: f32) {
        for frame in 0..=last {
            let path = self.folder.particles(frame, Format::Vtu.name());
            if path.exists() {
                let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
                self.series.push((f64::from(frame) / f64::from(frame_rate), name));
            }
        }
    }

    /// Adds a frame whose files are queued.
    pub fn expect(&mut self, frame: CompleteFrame) {
        self.pending.push_back(frame);
    }

    /// Removes and returns the first frames whose files are all written.
    pub fn take(
        &mut self,
        written: &[WrittenFile],
        no_pictures: bool,
    ) -> Result<Vec<CompleteFrame>, IoError> {
        self.written.extend(written.iter().skip(self.seen).map(|file| file.path.clone()));
        self.seen = written.len();
        let mut frames = Vec::new();
        while let Some(mut frame) = self.pending.pop_front() {
            if no_pictures {
                let written = &self.written;
                frame
                    .files
                    .retain(|file| written.contains(file) || file.extension().is_none_or(|end| end != "png"));
            }
            if !frame.files.iter().all(|file| self.written.contains(file)) {
                self.pending.push_front(frame);
                break;
            }
            frames.push(frame);
        }
        self.extend_index(&frames)?;
        Ok(frames)
    }

    /// Rewrites ParaView's index, so that the series can be opened while it grows.
    fn extend_index(&mut self, frames: &[CompleteFrame]) -> Result<(), IoError> {
        if frames.is_empty() || !self.indexed {
            return Ok(());
        }
        for frame in frames {
            let path = self.folder.particles(frame.summary.index, Format::Vtu.name());
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            self.series.push((frame.summary.stats.time, name));
        }
        pvd::write_index(&self.folder.index(), &self.series).map(|_| ())
    }
}
