//! Frames on their way to the disk: the writer works beside the simulation, and a frame is announced when all
//! of its files are complete.

use std::collections::{HashSet, VecDeque};
use std::path::PathBuf;
use std::sync::Arc;

use splashdown::scene::{Choice, Format, PictureKind, Scene};
use splashdown::{DiffuseKind, Frame};
use splashdown_io::usd::{MeshSeries, PointSeries};
use splashdown_io::{FrameWriter, IoError, Job, WrittenFile, pvd};

use crate::layout::Layout;

/// A frame whose files are all complete.
#[derive(Debug)]
pub struct CompleteFrame {
    /// The frame without its data.
    pub account: FrameAccount,
    /// Its files.
    pub files: Vec<PathBuf>,
}

/// What is told about a frame; the data themselves are let go as soon as they are written.
#[derive(Clone, Debug)]
pub struct FrameAccount {
    /// Number, from 0.
    pub index: u32,
    /// The simulation's own account.
    pub stats: splashdown::Stats,
    /// Enclosed volume of the surface in m^3.
    pub volume: Option<f64>,
    /// Triangles of the surface.
    pub triangles: Option<usize>,
}

impl FrameAccount {
    /// What is worth keeping of a frame.
    pub fn of(frame: &Frame) -> Self {
        Self {
            index: frame.index,
            stats: frame.stats,
            volume: frame.volume,
            triangles: frame.mesh.as_ref().map(|mesh| mesh.len()),
        }
    }
}

/// The files of a run.
#[derive(Debug)]
pub struct Files {
    writer: Arc<FrameWriter>,
    tracker: Tracker,
    /// The animated files, where they are wanted.
    points: Option<Arc<PointSeries>>,
    surface: Option<Arc<MeshSeries>>,
}

/// Which frames wait for which files.
#[derive(Debug)]
struct Tracker {
    layout: Layout,
    formats: Vec<Format>,
    pending: VecDeque<CompleteFrame>,
    written: HashSet<PathBuf>,
    seen: usize,
    series: Vec<(f64, String)>,
}

impl Files {
    /// Starts the writer. Animated files of a run that goes on after a frame hold what comes then, and are named by the
    /// first of their frames.
    ///
    /// # Errors
    /// [`IoError::WriterStopped`]; [`IoError::Write`] if an animated file cannot be begun.
    pub fn start(
        layout: Layout,
        scene: &Scene,
        surface: bool,
        resumed_after: Option<u32>,
    ) -> Result<Self, IoError> {
        let formats = scene.output.formats.clone();
        let animated = formats.contains(&Format::Usd);
        let rate = f64::from(scene.frame_rate);
        let first = resumed_after.map(|frame| frame + 1);
        let begin_points = || {
            let path = layout.animated(PictureKind::Particles, first);
            PointSeries::start(&path, rate, scene.fluid.particle_spacing)
        };
        let begin_surface = || MeshSeries::start(&layout.animated(PictureKind::Surface, first), rate);
        let points = animated.then(begin_points).transpose()?.map(Arc::new);
        let surface = (animated && surface).then(begin_surface).transpose()?.map(Arc::new);
        let tracker = Tracker {
            layout,
            formats,
            pending: VecDeque::new(),
            written: HashSet::new(),
            seen: 0,
            series: Vec::new(),
        };
        Ok(Self { writer: Arc::new(FrameWriter::start()?), tracker, points, surface })
    }

    /// Frames that are there already, up to this one, as far as ParaView's index names them.
    pub fn resume(&mut self, last: u32, frame_rate: f32) {
        for frame in 0..=last {
            let path = self.tracker.layout.particles(frame, Format::Vtu.name());
            if path.exists() {
                let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
                self.tracker.series.push((f64::from(frame) / f64::from(frame_rate), name));
            }
        }
    }

    /// The writer, for whoever draws pictures.
    pub fn writer(&self) -> Arc<FrameWriter> {
        Arc::clone(&self.writer)
    }

    /// Hands a frame over; `pictures` are the names of the pictures that will be drawn of it.
    ///
    /// # Errors
    /// The first failure of an earlier frame.
    pub fn submit(&mut self, frame: &Frame, pictures: Vec<PathBuf>) -> Result<(), IoError> {
        let mut jobs = Vec::new();
        let mut files = Vec::new();
        let kinds =
            frame.foam.iter().flat_map(|foam| DiffuseKind::ALL.map(|(kind, name)| (foam, kind, name)));
        let diffuse: Vec<_> = kinds.map(|(foam, kind, name)| (name, Arc::new(foam.of_kind(kind)))).collect();
        for format in &self.tracker.formats {
            if format.has_particles() && format.is_numbered() {
                let path = self.tracker.layout.particles(frame.index, format.name());
                files.push(path.clone());
                jobs.push(Job::Particles(path, Arc::clone(&frame.particles)));
                for (name, particles) in &diffuse {
                    let path = self.tracker.layout.diffuse(name, frame.index, format.name());
                    files.push(path.clone());
                    jobs.push(Job::Particles(path, Arc::clone(particles)));
                }
            }
            if let (true, true, Some(mesh)) = (format.has_surface(), format.is_numbered(), &frame.mesh) {
                let path = self.tracker.layout.mesh(frame.index, format.name());
                files.push(path.clone());
                jobs.push(Job::Mesh(path, Arc::clone(mesh)));
            }
        }
        if let Some(points) = &self.points {
            jobs.push(Job::UsdPoints(Arc::clone(points), frame.index, Arc::clone(&frame.particles)));
        }
        if let (Some(surface), Some(mesh)) = (&self.surface, &frame.mesh) {
            jobs.push(Job::UsdMesh(Arc::clone(surface), frame.index, Arc::clone(mesh)));
        }
        if !jobs.is_empty() {
            self.writer.submit(jobs)?;
        }
        files.extend(pictures);
        self.tracker.pending.push_back(CompleteFrame { account: FrameAccount::of(frame), files });
        Ok(())
    }

    /// Frames whose files have become complete since the last call, in order. With `no_pictures`, pictures that were
    /// promised are no longer waited for.
    ///
    /// # Errors
    /// If ParaView's index cannot be written.
    pub fn completed(&mut self, no_pictures: bool) -> Result<Vec<CompleteFrame>, IoError> {
        let written = self.writer.written();
        self.tracker.take(&written, no_pictures)
    }

    /// Waits until everything is written. Whoever else holds the writer must have let it go.
    pub fn finish(self, no_pictures: bool) -> Finished {
        let Self { writer, mut tracker, points, surface } = self;
        let (mut files, mut failure) = match Arc::into_inner(writer).map(FrameWriter::finish) {
            Some(Ok(files)) => (files, None),
            Some(Err(failure)) => (failure.written, Some(failure.error)),
            None => (Vec::new(), Some(IoError::WriterStopped { reason: "it is still in use".to_owned() })),
        };
        let frames = tracker.take(&files, no_pictures).unwrap_or_else(|error| {
            failure.get_or_insert(error);
            Vec::new()
        });
        // Whatever ended the run, what has been written so far becomes a whole file.
        for animated in [points.map(|points| points.finish()), surface.map(|surface| surface.finish())] {
            match animated {
                Some(Ok(Some((path, bytes)))) => files.push(WrittenFile { path, bytes }),
                Some(Err(error)) => {
                    failure.get_or_insert(error);
                }
                Some(Ok(None)) | None => {}
            }
        }
        Finished { frames, files, failure }
    }
}

/// The end of the files.
#[derive(Debug)]
pub struct Finished {
    /// Frames that became complete while waiting.
    pub frames: Vec<CompleteFrame>,
    /// All files, in the order in which they were written.
    pub files: Vec<WrittenFile>,
    /// The first failure.
    pub failure: Option<IoError>,
}

impl Tracker {
    /// Frames whose files are all among the written ones.
    fn take(&mut self, written: &[WrittenFile], no_pictures: bool) -> Result<Vec<CompleteFrame>, IoError> {
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
        self.extend_series(&frames)?;
        Ok(frames)
    }

    /// Writes ParaView's index anew, so that the series can be looked at while it grows.
    fn extend_series(&mut self, frames: &[CompleteFrame]) -> Result<(), IoError> {
        if frames.is_empty() || !self.formats.contains(&Format::Vtu) {
            return Ok(());
        }
        for frame in frames {
            let path = self.layout.particles(frame.account.index, Format::Vtu.name());
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            self.series.push((frame.account.stats.time, name));
        }
        pvd::write_index(&self.layout.index(), &self.series).map(|_| ())
    }
}
