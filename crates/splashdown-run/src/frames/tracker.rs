//! Tracks which frames still wait for which files.

use std::collections::{HashSet, VecDeque};
use std::path::PathBuf;

use splashdown_io::{IoError, WrittenFile};

use super::CompleteFrame;
use super::index::Index;

/// Frames in the queue of the writer, and ParaView's indices of those that are complete.
#[derive(Debug)]
pub struct Tracker {
    indices: Vec<Index>,
    pending: VecDeque<CompleteFrame>,
    written: HashSet<PathBuf>,
    seen: usize,
}

impl Tracker {
    /// For a run with these indices, which may already list earlier frames.
    pub fn new(indices: Vec<Index>) -> Self {
        Self { indices, pending: VecDeque::new(), written: HashSet::new(), seen: 0 }
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
        self.indices.iter_mut().try_for_each(|index| index.extend(&frames))?;
        Ok(frames)
    }
}
