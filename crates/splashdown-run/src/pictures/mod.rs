//! Pictures of the frames, drawn by a separate thread while the simulation continues.

mod beside;
mod draw;
mod droplets;
mod finished;
mod known_bodies;
mod motion;
mod orbit;
mod painter;

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, OnceLock};
use std::thread::{self, JoinHandle};

use splashdown::BodyState;
use splashdown::foam::DiffuseParticles;
use splashdown::scene::PictureKind;
use splashdown_gpu::{DeviceRequest, Gpu};
use splashdown_io::{Film, FrameWriter, IoError, Job, Mesh, Particles};
use splashdown_render::{MemoryForecast, Offscreen};

use crate::{PictureTimings, RunError, RunFolder};
pub(crate) use draw::FrameRenderer;

pub use beside::Beside;
pub use finished::{FinishedFrame, FinishedRun};
pub(crate) use motion::is_blurred;
pub use orbit::Orbit;
pub use painter::Painter;

/// Number of frames that can wait while one is drawn.
const QUEUE: usize = 1;

/// What the thread has drawn in the end.
#[derive(Debug, Default)]
pub(crate) struct Drawn {
    /// The films, whose last pictures the writer may still have to add.
    pub films: Vec<Arc<Film>>,
    pub timings: PictureTimings,
    /// Why pictures are missing.
    pub failure: Option<RunError>,
}

/// Draws the frames of a run.
#[derive(Debug)]
pub(crate) struct Pictures {
    kinds: Vec<PictureKind>,
    folder: RunFolder,
    queue: SyncSender<FrameData>,
    thread: JoinHandle<PictureTimings>,
    failure: Arc<OnceLock<RunError>>,
    films: Vec<Arc<Film>>,
}

/// The data from which the pictures of a frame are drawn.
#[derive(Debug)]
pub(crate) struct FrameData {
    index: u32,
    time: f64,
    particles: Arc<Particles>,
    mesh: Option<Arc<Mesh>>,
    droplets: Option<Arc<Particles>>,
    foam: Option<Arc<DiffuseParticles>>,
    bodies: Arc<[BodyState]>,
}

/// Opens a device to draw with: the GPU of the simulation, else the best adapter, software drivers included.
///
/// # Errors
/// [`RunError::Gpu`] without a driver; the message says what to install.
pub(crate) fn drawing_device(simulation: Option<&Arc<Gpu>>) -> Result<Arc<Gpu>, RunError> {
    match simulation {
        Some(gpu) => Ok(Arc::clone(gpu)),
        None => Ok(Arc::new(Gpu::open(&DeviceRequest::Auto)?)),
    }
}

/// The memory for drawing pictures of this size in pixels.
pub fn picture_memory(size: [u32; 2]) -> MemoryForecast {
    Offscreen::memory_forecast(size)
}

/// Where the thread sends its pictures.
struct Destination {
    kinds: Vec<PictureKind>,
    films: Vec<Arc<Film>>,
    folder: RunFolder,
    writer: Arc<FrameWriter>,
}

impl Pictures {
    /// Starts the thread with the pictures of `renderer`. `films` has one film per kind, or none.
    ///
    /// # Errors
    /// [`RunError::Io`] if the system has no thread.
    pub fn start(
        mut renderer: FrameRenderer,
        kinds: Vec<PictureKind>,
        films: Vec<Arc<Film>>,
        folder: &RunFolder,
        writer: Arc<FrameWriter>,
    ) -> Result<Self, RunError> {
        let destination =
            Destination { kinds: kinds.clone(), films: films.clone(), folder: folder.clone(), writer };
        let (queue, frames) = sync_channel(QUEUE);
        let failure = Arc::new(OnceLock::new());
        let report = Arc::clone(&failure);
        let body = move || {
            if let Err(error) = draw_all(&mut renderer, &destination, &frames) {
                // Only this thread sets it, once.
                let _ = report.set(error);
            }
            renderer.take_timings()
        };
        let thread = thread::Builder::new()
            .name("splashdown-pictures".to_owned())
            .spawn(body)
            .map_err(|error| IoError::WriterStopped { reason: error.to_string() })?;
        Ok(Self { kinds, folder: folder.clone(), queue, thread, failure, films })
    }

    /// The files of the pictures of a frame.
    pub fn names(&self, frame: u32) -> Vec<PathBuf> {
        self.kinds.iter().map(|&kind| self.folder.picture(kind, frame)).collect()
    }

    /// Queues a frame; blocks while [`QUEUE`] frames wait.
    pub fn submit(&self, frame: &splashdown::run::Frame) {
        let data = FrameData {
            index: frame.index,
            time: frame.time,
            particles: Arc::clone(&frame.particles),
            mesh: frame.mesh.clone(),
            droplets: frame.droplets.clone(),
            foam: frame.foam.clone(),
            bodies: Arc::clone(&frame.bodies),
        };
        // If the thread has ended, `failure` contains the reason.
        let _ = self.queue.send(data);
    }

    /// Why no more pictures are drawn.
    pub fn failure(&self) -> Option<&RunError> {
        self.failure.get()
    }

    /// Waits for the last picture.
    pub fn finish(self) -> Drawn {
        drop(self.queue);
        let joined = self.thread.join();
        let failure = Arc::into_inner(self.failure).and_then(OnceLock::into_inner);
        let stopped = || IoError::WriterStopped { reason: "the drawing thread panicked".to_owned() }.into();
        let failure = failure.or_else(|| joined.is_err().then(stopped));
        Drawn { films: self.films, timings: joined.unwrap_or_default(), failure }
    }
}

/// Draws until the queue is closed.
fn draw_all(
    renderer: &mut FrameRenderer,
    destination: &Destination,
    frames: &Receiver<FrameData>,
) -> Result<(), RunError> {
    let Destination { kinds, films, folder, writer } = destination;
    for data in frames {
        let pictures = renderer.draw(&data)?;
        let mut jobs = Vec::new();
        for (i, (kind, picture)) in kinds.iter().zip(pictures).enumerate() {
            jobs.push(Job::Png(folder.picture(*kind, data.index), Arc::clone(&picture)));
            if let Some(film) = films.get(i) {
                jobs.push(Job::Film(Arc::clone(film), picture));
            }
        }
        // The run reports a failure of the writer.
        if writer.submit(jobs).is_err() {
            break;
        }
    }
    Ok(())
}
