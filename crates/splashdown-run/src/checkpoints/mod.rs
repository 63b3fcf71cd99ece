//! The checkpoints of a run: when they are taken and when they are written.

mod find;

pub use find::{FoundCheckpoint, find_checkpoint, recent_checkpoints};

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use splashdown::{Checkpoint, Run};
use splashdown_io::{WrittenFile, prepare_folder};

use crate::frames::FrameFiles;
use crate::settings::Notes;
use crate::{RunError, RunFolder};

/// Number of checkpoints that remain on the disk. The second is used if the newest is damaged. An older one is removed
/// when a newer one is complete, so that this many are complete at any time.
const COUNT: usize = 2;

/// Takes and writes the checkpoints of a run. Each is written when the files of all frames up to it are complete, so
/// that a resumed run finds them.
#[derive(Debug)]
pub(crate) struct CheckpointWriter {
    folder: RunFolder,
    every: Option<u32>,
    notes: Notes,
    taken: VecDeque<(u32, Checkpoint)>,
    last: Option<u32>,
    held: Option<Held>,
}

/// A checkpoint in memory, which is written if a later frame fails.
#[derive(Debug)]
struct Held {
    frame: u32,
    checkpoint: Checkpoint,
    /// When it was complete, and how long it took.
    since: Instant,
    cost: Duration,
}

/// Time between two checkpoints in memory, as a multiple of the time that one takes.
const HOLD_EVERY: u32 = 100;

impl CheckpointWriter {
    /// Takes a checkpoint after every `every` frames; `None`: only when the run stops.
    pub fn new(folder: RunFolder, every: Option<u32>, notes: Notes) -> Self {
        Self { folder, every, notes, taken: VecDeque::new(), last: None, held: None }
    }

    /// Whether a checkpoint is due after this frame.
    pub fn due(&self, frame: u32) -> bool {
        self.every.is_some_and(|every| frame.is_multiple_of(every) && frame > 0)
    }

    /// Replaces the checkpoint in memory by one of the current frame, if the last one is old compared with its cost: at
    /// most one per cent of the time is spent on them.
    ///
    /// # Errors
    /// As [`Run::checkpoint`].
    pub fn hold(&mut self, run: &mut Run, frame: u32, table_bytes: Vec<u64>) -> Result<(), RunError> {
        if self.held.as_ref().is_some_and(|held| held.since.elapsed() < HOLD_EVERY * held.cost) {
            return Ok(());
        }
        let begun = Instant::now();
        let checkpoint = self.annotated(run, table_bytes)?;
        self.held = Some(Held { frame, checkpoint, since: Instant::now(), cost: begun.elapsed() });
        Ok(())
    }

    /// Takes the checkpoint in memory, if it is newer than the last one and there are frames before it.
    pub fn take_held(&mut self) {
        if let Some(Held { frame, checkpoint, .. }) = self.held.take()
            && frame > 0
            && self.last.is_none_or(|last| last < frame)
        {
            self.taken.push_back((frame, checkpoint));
            self.last = Some(frame);
        }
    }

    fn annotated(&mut self, run: &mut Run, table_bytes: Vec<u64>) -> Result<Checkpoint, RunError> {
        let mut checkpoint = run.checkpoint()?;
        self.notes.table_bytes = table_bytes;
        checkpoint.set_notes(&self.notes.to_json());
        Ok(checkpoint)
    }

    /// Takes a checkpoint of the current frame, unless it is already taken.
    ///
    /// # Errors
    /// As [`Run::checkpoint`].
    pub fn take(&mut self, run: &mut Run, frame: u32, table_bytes: Vec<u64>) -> Result<(), RunError> {
        if self.last == Some(frame) {
            return Ok(());
        }
        let checkpoint = self.annotated(run, table_bytes)?;
        self.taken.push_back((frame, checkpoint));
        self.last = Some(frame);
        Ok(())
    }

    /// Queues the checkpoints whose frames are complete.
    ///
    /// # Errors
    /// The writer's first failure.
    pub fn write(&mut self, complete: u32, files: &FrameFiles) -> Result<(), RunError> {
        while let Some((frame, checkpoint)) = self.taken.pop_front_if(|(frame, _)| *frame <= complete) {
            files.submit_checkpoint(self.folder.checkpoint(frame), checkpoint.to_bytes()?)?;
        }
        if self.last.is_some() {
            self.folder.remove_old_checkpoints(COUNT);
        }
        Ok(())
    }

    /// Writes the remaining checkpoints after the writer has ended, and returns their files.
    ///
    /// # Errors
    /// [`RunError::Io`], [`RunError::Checkpoint`].
    pub fn finish(mut self, complete: Option<u32>) -> Result<Vec<WrittenFile>, RunError> {
        let mut written = Vec::new();
        while let Some((frame, checkpoint)) = self.taken.pop_front() {
            if complete.is_some_and(|complete| frame <= complete) {
                prepare_folder(&self.folder.checkpoint_folder())?;
                let path = self.folder.checkpoint(frame);
                let bytes = checkpoint.write(&path)?;
                written.push(WrittenFile { path, bytes });
            }
        }
        self.folder.remove_old_checkpoints(COUNT);
        Ok(written)
    }
}
