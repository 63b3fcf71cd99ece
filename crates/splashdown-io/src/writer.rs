//! Writing beside the simulation: a thread that takes whole frames from a short queue.
//!
//! A frame is a list of jobs and takes one place in the queue. While there is room, handing one over costs nothing;
//! when the disk is slower than the simulation the queue fills and [`FrameWriter::submit`] waits, so memory stays
//! bounded. After the first failure nothing more is written: every later call returns that failure, and the files
//! written before stay as they are.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};

use crate::atomic;
use crate::error::IoError;
use crate::film::Film;
use crate::mesh::{self, Mesh};
use crate::particles::{self, Particles};
use crate::picture::Picture;
use crate::usd::{MeshSeries, PointSeries};

/// One file to write, or one frame to add to a film or series. Data is shared, so several formats cost no copy.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum Job {
    /// Particles, in the format that the path's ending names ([`particles::FORMATS`]).
    Particles(PathBuf, Arc<Particles>),
    /// A mesh, in the format that the path's ending names ([`mesh::FORMATS`]).
    Mesh(PathBuf, Arc<Mesh>),
    /// A picture as PNG.
    #[cfg(feature = "png")]
    Png(PathBuf, Arc<Picture>),
    /// Bytes as they are (an index, a report).
    Bytes(PathBuf, Vec<u8>),
    /// The next picture of a film. A film that fails does not stop the writer: it keeps its failure for
    /// [`Film::finish`], because the pictures are what matters and the film can be made from them later.
    Film(Arc<Film>, Arc<Picture>),
    /// A frame's number and mesh for an animated surface, which [`MeshSeries::finish`] makes a file of.
    UsdMesh(Arc<MeshSeries>, u32, Arc<Mesh>),
    /// A frame's number and particles for animated particles, which [`PointSeries::finish`] makes a file of.
    UsdPoints(Arc<PointSeries>, u32, Arc<Particles>),
}

impl Job {
    /// Whether the job leaves a file of its own.
    fn is_file(&self) -> bool {
        !matches!(self, Self::Film(..) | Self::UsdMesh(..) | Self::UsdPoints(..))
    }
}

/// A file that is complete on disk.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WrittenFile {
    /// Where it is.
    pub path: PathBuf,
    /// Its size in bytes.
    pub bytes: u64,
}

/// The failure of a writer, with what was written before it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{error} ({} files are complete, {lost} were not written)", written.len())]
pub struct WriteFailure {
    /// The first failure.
    pub error: IoError,
    /// The files that are complete.
    pub written: Vec<WrittenFile>,
    /// How many files were handed over and are not there.
    pub lost: usize,
}

/// What the thread and its owner share.
#[derive(Debug, Default)]
struct Progress {
    /// Files handed over, whether they were taken or refused.
    handed: usize,
    written: Vec<WrittenFile>,
    error: Option<IoError>,
}

/// A background thread that writes frames. Dropping it waits for the frames handed over; only
/// [`FrameWriter::finish`] tells whether they arrived.
#[derive(Debug)]
pub struct FrameWriter {
    queue: Option<SyncSender<Vec<Job>>>,
    thread: Option<JoinHandle<()>>,
    progress: Arc<Mutex<Progress>>,
}

impl FrameWriter {
    /// Frames that wait while one is being written.
    pub const QUEUE: usize = 3;

    /// Starts the thread (`splashdown-writer`).
    ///
    /// # Errors
    /// [`IoError::WriterStopped`] if the system gives no thread.
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

    /// Hands over one frame's files, to be written in this order. Waits while [`FrameWriter::QUEUE`] frames wait.
    ///
    /// # Errors
    /// The first failure of an earlier frame, if there was one; this frame is then not written.
    pub fn submit(&self, frame: Vec<Job>) -> Result<(), IoError> {
        let error = {
            let mut progress = lock(&self.progress);
            progress.handed += frame.iter().filter(|job| job.is_file()).count();
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

    /// Waits until everything handed over is written; returns all files in order.
    ///
    /// # Errors
    /// The first failure, with the files that are complete.
    pub fn finish(mut self) -> Result<Vec<WrittenFile>, Box<WriteFailure>> {
        let joined = self.join();
        let Progress { handed, written, error } = std::mem::take(&mut *lock(&self.progress));
        match error.or(joined.err()) {
            None => Ok(written),
            Some(error) => Err(Box::new(WriteFailure { error, lost: handed - written.len(), written })),
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
        // A failure has no way out of here; `finish` is the way to learn of it.
        let _ = self.join();
    }
}

fn stopped() -> IoError {
    IoError::WriterStopped { reason: "its thread ended by a panic".to_owned() }
}

/// A panic while the lock was held leaves plain counters behind; they are still worth reporting.
fn lock(progress: &Mutex<Progress>) -> MutexGuard<'_, Progress> {
    progress.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The thread: writes until the queue is closed. After a failure it only empties the queue, so that nobody waits.
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

/// Writes one file; a frame of a film or series yields none.
fn write(job: &Job) -> Result<Option<WrittenFile>, IoError> {
    let file = |path: &Path, bytes| Some(WrittenFile { path: path.to_owned(), bytes });
    Ok(match job {
        Job::Particles(path, particles) => file(path, particles::write(path, particles)?),
        Job::Mesh(path, mesh) => file(path, mesh::write(path, mesh)?),
        #[cfg(feature = "png")]
        Job::Png(path, picture) => file(path, crate::picture::write_png(path, picture)?),
        Job::Bytes(path, bytes) => file(path, atomic::write(path, |out| out.write_all(bytes))?),
        Job::Film(film, picture) => {
            film.push(picture);
            None
        }
        Job::UsdMesh(series, frame, mesh) => {
            series.push(*frame, mesh)?;
            None
        }
        Job::UsdPoints(series, frame, particles) => {
            series.push(*frame, particles)?;
            None
        }
    })
}
