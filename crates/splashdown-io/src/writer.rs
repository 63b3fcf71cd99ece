//! A thread that writes frames while the simulation continues.
//!
//! A frame is a list of jobs and takes one place in a short queue. If the disk is slower than the simulation, the queue
//! fills and [`FrameWriter::submit`] waits, so that the memory is bounded. After the first failure nothing more is
//! written: every later call returns that failure. The files written before it remain.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};

use crate::atomic;
use crate::data::Mesh;
use crate::data::Particles;
use crate::error::IoError;
use crate::film::Film;
use crate::gltf;
use crate::mesh::write_mesh;
use crate::particles::write_particles;
use crate::picture::Picture;
use crate::stage::Sample;
use crate::stage_file::StageFile;

/// One file to write, or one frame of a film or series. Data is shared, so that several formats need no copy.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum Job {
    /// Particles, for [`write_particles`].
    Particles(PathBuf, Arc<Particles>),
    /// A mesh, for [`write_mesh`].
    Mesh(PathBuf, Arc<Mesh>),
    /// Particles as points of a glTF file, for [`gltf::write_points`](crate::gltf::write_points).
    Points(PathBuf, Arc<Particles>),
    /// A picture as PNG.
    #[cfg(feature = "png")]
    Png(PathBuf, Arc<Picture>),
    /// Bytes, such as an index or a report.
    Bytes(PathBuf, Vec<u8>),
    /// The next picture of a film. A failure of the film does not stop the writer, because the film can be made from the
    /// pictures later; [`Film::finish`] reports it.
    Film(Arc<Film>, Arc<Picture>),
    /// A frame of an animated scene: its number, and the number of each object with its data;
    /// [`StageFile::finish`] writes the files.
    Stage(Arc<StageFile>, u32, Vec<(usize, Sample)>),
    /// Flushes the frames of an animated scene to the disk.
    SyncStage(Arc<StageFile>),
}

impl Job {
    /// Whether the job writes a file, not a frame of a film or series.
    fn is_file(&self) -> bool {
        !matches!(self, Self::Film(..) | Self::Stage(..) | Self::SyncStage(..))
    }
}

/// A complete file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WrittenFile {
    /// Its path.
    pub path: PathBuf,
    /// Its size in bytes.
    pub bytes: u64,
}

/// The failure of a writer, with the files written before it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{error} ({} files are complete, {lost} were not written)", written.len())]
pub struct WriteFailure {
    /// The first failure.
    pub error: IoError,
    /// The files that are complete.
    pub written: Vec<WrittenFile>,
    /// Number of submitted files that were not written.
    pub lost: usize,
}

/// State shared by the thread and its owner.
#[derive(Debug, Default)]
struct Progress {
    /// Number of submitted files, accepted or refused.
    submitted: usize,
    written: Vec<WrittenFile>,
    error: Option<IoError>,
}

/// A background thread that writes frames. Dropping it waits for the submitted frames; only [`FrameWriter::finish`]
/// reports whether they were written.
#[derive(Debug)]
pub struct FrameWriter {
    queue: Option<SyncSender<Vec<Job>>>,
    thread: Option<JoinHandle<()>>,
    progress: Arc<Mutex<Progress>>,
}

impl FrameWriter {
    /// Number of frames that can wait while one is written.
    pub const QUEUE: usize = 3;

    /// Starts the thread (`splashdown-writer`).
    ///
    /// # Errors
    /// [`IoError::WriterStopped`] if the system cannot start a thread.
    pub fn start() -> Result<Self, IoError> {
        let (queue, frames) = sync_channel(Self::QUEUE);
        let progress = Arc::new(Mutex::new(Progress::default()));
        let shared = Arc::clone(&progress);
        let thread = thread::Builder::new()
            .name("splashdown-writer".to_owned())
            .spawn(move || write_frames(&frames, &shared))
            .map_err(|error| IoError::WriterStopped { reason: error.to_string() })?;
        Ok(Self { queue: Some(queue), thread: Some(thread), progress })
    }

    /// Submits the files of a frame, to be written in this order. Blocks while [`FrameWriter::QUEUE`] frames wait.
    ///
    /// # Errors
    /// The first failure of an earlier frame; this frame is then not written.
    pub fn submit(&self, frame: Vec<Job>) -> Result<(), IoError> {
        let error = {
            let mut progress = lock(&self.progress);
            progress.submitted += frame.iter().filter(|job| job.is_file()).count();
            progress.error.clone()
        };
        match (error, &self.queue) {
            (Some(error), _) => Err(error),
            (None, Some(queue)) => queue.send(frame).map_err(|_| stopped()),
            (None, None) => Err(stopped()),
        }
    }

    /// The files written so far, in order.
    #[must_use]
    pub fn written(&self) -> Vec<WrittenFile> {
        lock(&self.progress).written.clone()
    }

    /// Waits until all submitted frames are written; returns all files in order.
    ///
    /// # Errors
    /// The first failure, with the files that are complete.
    pub fn finish(mut self) -> Result<Vec<WrittenFile>, Box<WriteFailure>> {
        let joined = self.join();
        let Progress { submitted, written, error } = std::mem::take(&mut *lock(&self.progress));
        match error.or(joined.err()) {
            None => Ok(written),
            Some(error) => Err(Box::new(WriteFailure { error, lost: submitted - written.len(), written })),
        }
    }

    /// Closes the queue and waits for the thread.
    fn join(&mut self) -> Result<(), IoError> {
        drop(self.queue.take());
        self.thread.take().map_or(Ok(()), |thread| thread.join().map_err(|_| stopped()))
    }
}

impl Drop for FrameWriter {
    fn drop(&mut self) {
        // A failure cannot be returned here; `finish` reports it.
        let _ = self.join();
    }
}

fn stopped() -> IoError {
    IoError::WriterStopped { reason: "its thread panicked".to_owned() }
}

/// Locks the progress. If another thread has panicked while it held the lock, the counters are still valid.
fn lock(progress: &Mutex<Progress>) -> MutexGuard<'_, Progress> {
    progress.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The thread: writes until the queue is closed. After a failure it only empties the queue, so that no caller blocks.
fn write_frames(frames: &Receiver<Vec<Job>>, progress: &Mutex<Progress>) {
    for frame in frames {
        for job in frame {
            if lock(progress).error.is_some() {
                break;
            }
            match write(&job) {
                Ok(Some(file)) => lock(progress).written.push(file),
                Ok(None) => {}
                Err(error) => lock(progress).error = Some(error),
            }
        }
    }
}

/// Writes one file; a frame of a film or series returns none.
fn write(job: &Job) -> Result<Option<WrittenFile>, IoError> {
    let file = |path: &Path, bytes| Some(WrittenFile { path: path.to_owned(), bytes });
    Ok(match job {
        Job::Particles(path, particles) => file(path, write_particles(path, particles)?),
        Job::Points(path, particles) => file(path, gltf::write_points(path, particles)?),
        Job::Mesh(path, mesh) => file(path, write_mesh(path, mesh)?),
        #[cfg(feature = "png")]
        Job::Png(path, picture) => file(path, crate::picture::write_png(path, picture)?),
        Job::Bytes(path, bytes) => file(path, atomic::write(path, |out| out.write_all(bytes))?),
        Job::Film(film, picture) => {
            film.push(picture);
            None
        }
        Job::Stage(stage, frame, samples) => {
            stage.push(*frame, samples)?;
            None
        }
        Job::SyncStage(stage) => {
            stage.sync()?;
            None
        }
    })
}
