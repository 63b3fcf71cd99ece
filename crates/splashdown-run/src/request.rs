//! The scene or checkpoint to run, with its settings.

use std::path::{Path, PathBuf};

use splashdown::Device;
use splashdown::scene::{PictureKind, Scene};

use crate::settings::Notes;
use crate::{FoundCheckpoint, RunError, RunSettings, find_checkpoint};

/// A scene or a checkpoint, and the settings to run it with.
#[derive(Debug)]
pub struct RunRequest {
    /// The output folder. `None`: that of the run to resume, else `out/` and the scene's name.
    pub out: Option<PathBuf>,
    /// Measure the time of every pass.
    pub timing: bool,
    pub(crate) scene: Scene,
    pub(crate) settings: RunSettings,
    /// Whether a device that cannot draw is an error.
    pub(crate) pictures_required: bool,
    pub(crate) checkpoint: Option<FoundCheckpoint>,
}

impl RunRequest {
    /// A run of this scene from its start.
    pub fn new(mut scene: Scene, settings: RunSettings) -> Self {
        settings.apply_to(&mut scene);
        let pictures_required = settings.requires_pictures();
        Self { out: None, timing: false, scene, settings, pictures_required, checkpoint: None }
    }

    /// A run that resumes from `path`: a checkpoint, an output folder, or its folder of checkpoints. The scene is the
    /// one in the checkpoint. Settings that are not given are those of the run that wrote the checkpoint.
    ///
    /// # Errors
    /// As [`find_checkpoint`]; [`RunError::Checkpoint`] for an unusable scene.
    pub fn resume(path: &Path, settings: RunSettings) -> Result<Self, RunError> {
        let found = find_checkpoint(path)?;
        let pictures_required = settings.requires_pictures();
        let settings = settings.or(found.notes.settings());
        let mut scene = found.checkpoint.scene()?;
        settings.apply_to(&mut scene);
        Ok(Self { out: None, timing: false, scene, settings, pictures_required, checkpoint: Some(found) })
    }

    /// The scene, changed by the settings.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Where to simulate.
    pub fn device(&self) -> Device {
        self.settings.device.clone().unwrap_or_default()
    }

    /// The frame after which the run ends.
    pub(crate) fn last_frame(&self) -> u32 {
        self.settings.frames.unwrap_or_else(|| self.scene.frame_count())
    }

    /// The pictures to draw.
    ///
    /// # Errors
    /// [`RunError::SurfaceRequired`].
    pub(crate) fn pictures(&self) -> Result<Vec<PictureKind>, RunError> {
        self.settings.pictures_of(&self.scene)
    }

    /// The notes in the checkpoints of this run.
    pub(crate) fn notes(&self) -> Notes {
        let mut notes = Notes::new(&self.settings);
        if let Some(FoundCheckpoint { notes: earlier, .. }) = &self.checkpoint {
            (notes.digits, notes.since) = (earlier.digits, earlier.since);
            notes.table_bytes.clone_from(&earlier.table_bytes);
        }
        notes
    }
}
