//! Writing frames. The writer runs concurrently with the simulation. A frame is reported when all of its files are
//! complete.

mod animated;
mod index;
mod tracker;

use std::path::PathBuf;
use std::sync::Arc;

use splashdown::foam::DiffuseKind;
use splashdown::run::Frame;
use splashdown::scene::{Format, Scene};
use splashdown::surface::{Walls, remove_caps};
use splashdown::{BodyMesh, Stats};
use splashdown_io::Particles;
use splashdown_io::{FrameWriter, IoError, Job, WrittenFile};

use crate::RunFolder;
use crate::folder::DROPLETS;
use animated::Animated;
use index::Index;
use tracker::Tracker;

/// A frame whose files are all complete.
#[derive(Debug)]
#[non_exhaustive]
pub struct CompleteFrame {
    /// The frame without its data.
    pub summary: FrameSummary,
    /// Its files.
    pub files: Vec<PathBuf>,
}

/// The numbers of a frame without its arrays, which are freed as soon as they are written.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct FrameSummary {
    /// Number, from 0.
    pub index: u32,
    /// The statistics of the simulation.
    pub stats: Stats,
    /// Volume enclosed by the surface, with that of the droplets, in m^3.
    pub volume: Option<f64>,
    /// Triangles of the surface.
    pub triangles: Option<usize>,
    /// Number of droplets.
    pub droplets: Option<usize>,
}

impl FrameSummary {
    fn of(frame: &Frame) -> Self {
        Self {
            index: frame.index,
            stats: frame.stats,
            volume: frame.volume,
            triangles: frame.mesh.as_ref().map(|mesh| mesh.len()),
            droplets: frame.droplets.as_ref().map(|droplets| droplets.len()),
        }
    }
}

/// The droplets and the diffuse particles of a frame, by the stem of their files, with time and particle spacing.
fn points_of(frame: &Frame) -> Vec<(&'static str, Arc<Particles>)> {
    let droplets = frame.droplets.iter().map(|droplets| (DROPLETS, Arc::clone(droplets)));
    let kinds = frame.foam.iter().flat_map(|foam| DiffuseKind::ALL.map(|(kind, name)| (foam, kind, name)));
    droplets
        .chain(
            kinds.map(|(foam, kind, name)| {
                (name, Arc::new(foam.of_kind(kind).with_info(frame.particles.info)))
            }),
        )
        .collect()
}

/// A frame without the triangles of its mesh that lie in walls; `None` if it has no mesh.
fn without_caps(frame: &Frame, walls: &Walls) -> Option<Frame> {
    let mut mesh = frame.mesh.as_ref()?.as_ref().clone();
    remove_caps(&mut mesh, walls);
    let mut open = frame.clone();
    open.mesh = Some(Arc::new(mesh));
    Some(open)
}

/// Writes the particles and meshes of a run.
#[derive(Debug)]
pub(crate) struct FrameFiles {
    writer: Arc<FrameWriter>,
    tracker: Tracker,
    folder: RunFolder,
    formats: Vec<Format>,
    animated: Animated,
    /// The walls whose triangles the meshes do not contain.
    open_walls: Option<Walls>,
}

impl FrameFiles {
    /// Starts the writer. `keep`: whether an interrupted run is to continue its files of all frames.
    ///
    /// # Errors
    /// [`IoError::WriterStopped`]; [`IoError::Write`] if a file cannot be created.
    pub fn start(
        folder: RunFolder,
        scene: &Scene,
        bodies: &[BodyMesh],
        resumed_after: Option<u32>,
        keep: bool,
    ) -> Result<Self, IoError> {
        let formats = scene.output.formats.clone();
        let animated = Animated::start(&folder, scene, bodies, resumed_after, keep)?;
        let mut indices = Index::all(&folder, scene);
        if let Some(last) = resumed_after {
            indices.iter_mut().for_each(|index| index.add_existing(last, scene.frame_rate));
        }
        let tracker = Tracker::new(indices);
        let writer = Arc::new(FrameWriter::start()?);
        let open_walls = (!scene.surface.caps).then(|| Walls::of_domain(&scene.domain));
        Ok(Self { writer, tracker, folder, formats, animated, open_walls })
    }

    /// The writer, shared with the thread that draws pictures.
    pub fn writer(&self) -> Arc<FrameWriter> {
        Arc::clone(&self.writer)
    }

    /// Queues a frame; `pictures` are the files that will be drawn of it.
    ///
    /// # Errors
    /// The first failure of an earlier frame.
    pub fn submit(&mut self, frame: &Frame, pictures: Vec<PathBuf>) -> Result<(), IoError> {
        let open = self.open_walls.as_ref().and_then(|walls| without_caps(frame, walls));
        let frame = open.as_ref().unwrap_or(frame);
        let mut jobs = Vec::new();
        let mut files = Vec::new();
        let points = points_of(frame);
        for format in self.formats.iter().filter(|format| format.is_numbered()) {
            if format.has_particles() {
                let path = self.folder.particles(frame.index, format.ending());
                files.push(path.clone());
                jobs.push(Job::Particles(path, Arc::clone(&frame.particles)));
                for (name, particles) in &points {
                    let path = self.folder.points(name, frame.index, format.ending());
                    files.push(path.clone());
                    jobs.push(Job::Particles(path, Arc::clone(particles)));
                }
            }
            if let (true, Some(mesh)) = (format.has_surface(), &frame.mesh) {
                let path = self.folder.mesh(frame.index, format.ending());
                files.push(path.clone());
                jobs.push(Job::Mesh(path, Arc::clone(mesh)));
            }
            if *format == Format::Glb {
                for (name, particles) in &points {
                    let path = self.folder.points(name, frame.index, format.ending());
                    files.push(path.clone());
                    jobs.push(Job::Points(path, Arc::clone(particles)));
                }
            }
        }
        jobs.extend(self.animated.jobs(frame, &points));
        if !jobs.is_empty() {
            self.writer.submit(jobs)?;
        }
        files.extend(pictures);
        self.tracker.expect(CompleteFrame { summary: FrameSummary::of(frame), files });
        Ok(())
    }

    /// Queues a checkpoint, after the frames of the scene files that it relies on.
    ///
    /// # Errors
    /// The first failure of an earlier frame.
    pub fn submit_checkpoint(&self, path: PathBuf, bytes: Vec<u8>) -> Result<(), IoError> {
        let mut jobs = self.animated.sync_jobs();
        jobs.push(Job::Bytes(path, bytes));
        self.writer.submit(jobs)
    }

    /// Frames whose files have become complete since the last call, in order. With `no_pictures`, expected pictures that
    /// are missing do not delay a frame.
    ///
    /// # Errors
    /// If an index for ParaView cannot be written.
    pub fn completed(&mut self, no_pictures: bool) -> Result<Vec<CompleteFrame>, IoError> {
        self.tracker.take(&self.writer.written(), no_pictures)
    }

    /// Waits until all but the files of all frames is written. No other owner of the writer may exist any more.
    pub fn finish(self, no_pictures: bool) -> FinishedFiles {
        let Self { writer, mut tracker, animated, .. } = self;
        let (files, mut failure) = match Arc::into_inner(writer).map(FrameWriter::finish) {
            Some(Ok(files)) => (files, None),
            Some(Err(failure)) => (failure.written, Some(failure.error)),
            None => (Vec::new(), Some(IoError::WriterStopped { reason: "it is still in use".to_owned() })),
        };
        let frames = tracker.take(&files, no_pictures).unwrap_or_else(|error| {
            failure.get_or_insert(error);
            Vec::new()
        });
        FinishedFiles { frames, files, failure, animated }
    }
}

/// The result of [`FrameFiles::finish`].
#[derive(Debug)]
pub(crate) struct FinishedFiles {
    /// Frames that became complete while waiting.
    pub frames: Vec<CompleteFrame>,
    /// All files, in the order in which they were written.
    pub files: Vec<WrittenFile>,
    /// The first failure.
    pub failure: Option<IoError>,
    /// The files of all frames, which are still to be completed.
    pub animated: Animated,
}
