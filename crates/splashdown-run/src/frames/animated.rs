//! The USD files of a run, which contain all of its frames.

use std::path::Path;
use std::sync::Arc;

use splashdown::run::Frame;
use splashdown::scene::{Format, PictureKind, Scene};
use splashdown_io::usd::{MeshSeries, PointSeries};
use splashdown_io::{IoError, Job, WrittenFile};

use crate::RunFolder;

/// The USD files in progress.
#[derive(Debug, Default)]
pub struct Animated {
    points: Option<Arc<PointSeries>>,
    surface: Option<Arc<MeshSeries>>,
    /// Whether frames are added. If not, the files of an interrupted run are only completed.
    grows: bool,
}

impl Animated {
    /// Starts the files that the scene requests. A resumed run continues those of the run before it. Where that is not
    /// possible, its files contain only its own frames and are named by the first of them.
    ///
    /// # Errors
    /// [`IoError::Write`] if a file cannot be created.
    pub fn start(
        folder: &RunFolder,
        scene: &Scene,
        resumed_after: Option<u32>,
        keep: bool,
    ) -> Result<Self, IoError> {
        let grows = scene.output.formats.contains(&Format::Usd);
        let rate = f64::from(scene.frame_rate);
        let diameter = scene.fluid.particle_spacing;
        let checkpoints = folder.checkpoint_folder();
        let keep = (keep || !folder.usd_parts().is_empty()).then_some(checkpoints.as_path());
        let mut animated = Self { points: None, surface: None, grows };
        // Without new frames only data that is not yet in a complete file is of interest.
        let resumes = |kind| grows || folder.has_usd_parts(kind);
        if let Some(last) = resumed_after {
            let path = |kind| folder.animated_at(kind, last);
            if resumes(PictureKind::Particles) {
                let path = path(PictureKind::Particles);
                animated.points = PointSeries::resume(&path, rate, diameter, keep, last)?.map(Arc::new);
            }
            if resumes(PictureKind::Surface) && (scene.surface.enabled || !grows) {
                let path = path(PictureKind::Surface);
                animated.surface = MeshSeries::resume(&path, rate, keep, last)?.map(Arc::new);
            }
        }
        if !grows {
            return Ok(animated);
        }
        let first = resumed_after.map(|frame| frame + 1);
        let path = |kind| folder.animated(kind, first);
        let points = |path: &Path| {
            PointSeries::start_in(path, rate, diameter, keep).map(|series| Some(Arc::new(series)))
        };
        let surface =
            |path: &Path| MeshSeries::start_in(path, rate, keep).map(|series| Some(Arc::new(series)));
        if animated.points.is_none() {
            animated.points = points(&path(PictureKind::Particles))?;
        }
        if animated.surface.is_none() && scene.surface.enabled {
            animated.surface = surface(&path(PictureKind::Surface))?;
        }
        Ok(animated)
    }

    /// Adds a frame.
    pub fn jobs(&self, frame: &Frame) -> Vec<Job> {
        let mut jobs = Vec::new();
        if let (Some(points), true) = (&self.points, self.grows) {
            jobs.push(Job::UsdPoints(Arc::clone(points), frame.index, Arc::clone(&frame.particles)));
        }
        if let (Some(surface), Some(mesh), true) = (&self.surface, &frame.mesh, self.grows) {
            jobs.push(Job::UsdMesh(Arc::clone(surface), frame.index, Arc::clone(mesh)));
        }
        jobs
    }

    /// Flushes the frames so far to the disk.
    pub fn sync_jobs(&self) -> Vec<Job> {
        let points = self.points.iter().map(|points| Job::SyncPoints(Arc::clone(points)));
        points.chain(self.surface.iter().map(|surface| Job::SyncMesh(Arc::clone(surface)))).collect()
    }

    /// Flushes the frames to the disk at once.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn sync(&self) -> Result<(), IoError> {
        self.points.as_ref().map_or(Ok(()), |points| points.sync())?;
        self.surface.as_ref().map_or(Ok(()), |surface| surface.sync())
    }

    /// Writes the files.
    pub fn finish(self) -> Vec<Result<WrittenFile, IoError>> {
        let ends = [self.points.map(|points| points.finish()), self.surface.map(|surface| surface.finish())];
        let files = ends.into_iter().flatten().filter_map(Result::transpose);
        files.map(|file| file.map(|(path, bytes)| WrittenFile { path, bytes })).collect()
    }
}
