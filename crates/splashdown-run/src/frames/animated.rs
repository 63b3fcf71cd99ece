//! The files of a run that contain all of its frames: the scene as USD and GLB, and the particles as USD.

mod stage;

use std::path::PathBuf;
use std::sync::Arc;

use splashdown::BodyMesh;
use splashdown::run::Frame;
use splashdown::scene::{Format, Scene};
use splashdown_io::{IoError, Job, Particles, StageFile, WrittenFile};

use crate::RunFolder;
use crate::folder::{PARTICLES_STEM, SCENE_FILE};
use stage::{Content, Layout};

/// The files in progress.
#[derive(Debug)]
pub struct Animated {
    files: Vec<(Layout, Arc<StageFile>)>,
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
        bodies: &[BodyMesh],
        resumed_after: Option<u32>,
        keep: bool,
    ) -> Result<Self, IoError> {
        let requested = &scene.output.formats;
        let grows = requested.iter().any(|format| matches!(format, Format::Usd | Format::Glb));
        let checkpoints = folder.checkpoint_folder();
        let keep = (keep || !folder.scene_parts().is_empty()).then_some(checkpoints.as_path());
        let first = resumed_after.map(|frame| frame + 1);
        let mut files = Vec::new();
        for (stem, layout) in
            [(SCENE_FILE, Layout::scene(scene, bodies)), (PARTICLES_STEM, Layout::particles(scene))]
        {
            let Some(layout) = layout else {
                folder.set_aside(stem);
                continue;
            };
            let formats: Vec<Format> = match (grows, stem) {
                (true, SCENE_FILE) => requested.iter().filter(|format| format.has_scene()).copied().collect(),
                (true, _) => requested.iter().filter(|&&format| format == Format::Usd).copied().collect(),
                (false, _) => Vec::new(),
            };
            // Data that is not yet in a complete file is completed, whatever is requested.
            let is_left = formats.is_empty() && folder.has_scene_part(stem);
            let formats = if is_left { vec![Format::Usd] } else { formats };
            if formats.is_empty() {
                continue;
            }
            let paths = |first| -> Vec<PathBuf> {
                formats.iter().map(|format| folder.animated_file(stem, first, format.ending())).collect()
            };
            let mut file = None;
            if let Some(last) = resumed_after {
                let paths = paths(folder.animated_at(stem, last));
                file = StageFile::resume(paths, layout.stage.clone(), keep, last)?;
            }
            if file.is_none() && grows {
                file = Some(StageFile::start(paths(first), layout.stage.clone(), keep)?);
            }
            files.extend(file.map(|file| (layout, Arc::new(file))));
        }
        Ok(Self { files, grows })
    }

    /// Adds a frame with its droplets and diffuse particles.
    pub fn jobs(&self, frame: &Frame, points: &[(&'static str, Arc<Particles>)]) -> Vec<Job> {
        if !self.grows {
            return Vec::new();
        }
        let content = Content { frame, points };
        let job = |(layout, file): &(Layout, Arc<StageFile>)| {
            Job::Stage(Arc::clone(file), frame.index, layout.samples(&content))
        };
        self.files.iter().map(job).collect()
    }

    /// Flushes the frames so far to the disk.
    pub fn sync_jobs(&self) -> Vec<Job> {
        self.files.iter().map(|(_, file)| Job::SyncStage(Arc::clone(file))).collect()
    }

    /// Flushes the frames to the disk at once.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn sync(&self) -> Result<(), IoError> {
        self.files.iter().try_for_each(|(_, file)| file.sync())
    }

    /// Writes the files.
    pub fn finish(self) -> Vec<Result<WrittenFile, IoError>> {
        let files = self.files.into_iter().flat_map(|(_, file)| file.finish());
        files.map(|file| file.map(|(path, bytes)| WrittenFile { path, bytes })).collect()
    }
}
