//! The USD files of a run, which contain all of its frames.

use std::path::Path;
use std::sync::Arc;

use splashdown::foam::DiffuseKind;
use splashdown::run::Frame;
use splashdown::scene::{Format, Scene};
use splashdown::surface::droplet_radius;
use splashdown_io::usd::{MeshSeries, PointSeries};
use splashdown_io::{IoError, Job, Particles, WrittenFile};

use crate::RunFolder;
use crate::folder::DROPLETS;

/// The stems of the files of particles and surface.
const PARTICLES: &str = "particles";
const SURFACE: &str = "surface";

/// The USD files in progress.
#[derive(Debug, Default)]
pub struct Animated {
    /// Particles, droplets and diffuse particles, by the stem of the file.
    points: Vec<(&'static str, Arc<PointSeries>)>,
    surface: Option<Arc<MeshSeries>>,
    /// Whether frames are added. If not, the files of an interrupted run are only completed.
    grows: bool,
}

/// The points that a scene can have: the stem of their file, their diameter in m, and whether the scene has them.
fn all_points(scene: &Scene) -> Vec<(&'static str, f32, bool)> {
    let spacing = scene.fluid.particle_spacing;
    let droplets = (DROPLETS, 2.0 * droplet_radius(spacing), scene.surface.separates());
    // As in pictures.
    let diameter = |kind| match kind {
        DiffuseKind::Spray => 0.26 * spacing,
        DiffuseKind::Foam => 0.5 * spacing,
        DiffuseKind::Bubble => 0.32 * spacing,
    };
    let diffuse = DiffuseKind::ALL.map(|(kind, name)| (name, diameter(kind), scene.foam.enabled));
    [(PARTICLES, spacing, true), droplets].into_iter().chain(diffuse).collect()
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
        let checkpoints = folder.checkpoint_folder();
        let keep = (keep || !folder.usd_parts().is_empty()).then_some(checkpoints.as_path());
        let mut animated = Self { points: Vec::new(), surface: None, grows };
        let first = resumed_after.map(|frame| frame + 1);
        let new = |stem: &str| folder.animated_file(stem, first);
        // Without new frames only data that is not yet in a complete file is of interest.
        let resumes = |stem, has: bool| if grows { has } else { folder.has_usd_parts(stem) };
        for (stem, diameter, has) in all_points(scene) {
            let mut series = None;
            if let Some(last) = resumed_after.filter(|_| resumes(stem, has)) {
                let path = folder.animated_at(stem, last);
                series = PointSeries::resume(&path, rate, diameter, keep, last)?;
            }
            if series.is_none() && grows && has {
                series = Some(PointSeries::start_in(&new(stem), rate, diameter, keep)?);
            }
            animated.points.extend(series.map(|series| (stem, Arc::new(series))));
        }
        animated.start_surface(folder, scene, resumed_after, (&new(SURFACE), keep))?;
        Ok(animated)
    }

    fn start_surface(
        &mut self,
        folder: &RunFolder,
        scene: &Scene,
        resumed_after: Option<u32>,
        (new, keep): (&Path, Option<&Path>),
    ) -> Result<(), IoError> {
        let rate = f64::from(scene.frame_rate);
        let has = scene.surface.enabled;
        let resumes = if self.grows { has } else { folder.has_usd_parts(SURFACE) };
        if let Some(last) = resumed_after.filter(|_| resumes) {
            let path = folder.animated_at(SURFACE, last);
            self.surface = MeshSeries::resume(&path, rate, keep, last)?.map(Arc::new);
        }
        if self.surface.is_none() && self.grows && has {
            self.surface = Some(Arc::new(MeshSeries::start_in(new, rate, keep)?));
        }
        Ok(())
    }

    /// Adds a frame with its droplets and diffuse particles.
    pub fn jobs(&self, frame: &Frame, points: &[(&'static str, Arc<Particles>)]) -> Vec<Job> {
        if !self.grows {
            return Vec::new();
        }
        let mut jobs = Vec::new();
        for (stem, series) in &self.points {
            let particles = match points.iter().find(|(other, _)| other == stem) {
                Some((_, particles)) => particles,
                None if *stem == PARTICLES => &frame.particles,
                None => continue,
            };
            jobs.push(Job::UsdPoints(Arc::clone(series), frame.index, Arc::clone(particles)));
        }
        if let (Some(surface), Some(mesh)) = (&self.surface, &frame.mesh) {
            jobs.push(Job::UsdMesh(Arc::clone(surface), frame.index, Arc::clone(mesh)));
        }
        jobs
    }

    /// Flushes the frames so far to the disk.
    pub fn sync_jobs(&self) -> Vec<Job> {
        let points = self.points.iter().map(|(_, points)| Job::SyncPoints(Arc::clone(points)));
        points.chain(self.surface.iter().map(|surface| Job::SyncMesh(Arc::clone(surface)))).collect()
    }

    /// Flushes the frames to the disk at once.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn sync(&self) -> Result<(), IoError> {
        self.points.iter().try_for_each(|(_, points)| points.sync())?;
        self.surface.as_ref().map_or(Ok(()), |surface| surface.sync())
    }

    /// Writes the files.
    pub fn finish(self) -> Vec<Result<WrittenFile, IoError>> {
        let points = self.points.into_iter().map(|(_, points)| points.finish());
        let ends = points.chain(self.surface.map(|surface| surface.finish()));
        let files = ends.filter_map(Result::transpose);
        files.map(|file| file.map(|(path, bytes)| WrittenFile { path, bytes })).collect()
    }
}
