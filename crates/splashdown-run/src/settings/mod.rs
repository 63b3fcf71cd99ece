//! The settings of a run.

mod notes;

pub(crate) use notes::Notes;

use splashdown::Device;
use splashdown::scene::{Format, OnBurst, PictureKind, PictureQuality, Scene};

use crate::RunError;

/// What to compute and write. `None` selects the value of the scene or, in a resumed run, of its checkpoint.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RunSettings {
    /// Where to simulate.
    pub device: Option<Device>,
    /// Number of frames after the initial one.
    pub frames: Option<u32>,
    /// File formats.
    pub formats: Option<Vec<Format>>,
    /// Extract the surface, if the scene enables it. Without it there are no meshes and no pictures of it.
    pub surface: bool,
    /// Blobs of fewer particles leave the surface and become droplets.
    pub min_blob: Option<u32>,
    /// Particles with fewer neighbours leave the surface and become droplets.
    pub min_neighbours: Option<u32>,
    /// Pictures; an empty list draws none. If pictures are given, a device that cannot draw them is an error.
    pub pictures: Option<Vec<PictureKind>>,
    /// How carefully pictures of the surface are drawn.
    pub quality: Option<PictureQuality>,
    /// Make films of the pictures, if the scene enables them.
    pub film: bool,
    /// Frames between two checkpoints.
    pub checkpoint_every: Option<u32>,
    /// What to do when the fluid bursts; `None` stops, or continues as the resumed run did.
    pub on_burst: Option<OnBurst>,
}

impl Default for RunSettings {
    fn default() -> Self {
        Self {
            device: None,
            frames: None,
            formats: None,
            surface: true,
            min_blob: None,
            min_neighbours: None,
            pictures: None,
            quality: None,
            film: true,
            checkpoint_every: None,
            on_burst: None,
        }
    }
}

impl RunSettings {
    /// These settings, completed by those of the run to resume.
    pub(crate) fn or(self, earlier: Self) -> Self {
        Self {
            device: self.device.or(earlier.device),
            frames: self.frames.or(earlier.frames),
            formats: self.formats.or(earlier.formats),
            surface: self.surface && earlier.surface,
            min_blob: self.min_blob.or(earlier.min_blob),
            min_neighbours: self.min_neighbours.or(earlier.min_neighbours),
            pictures: self.pictures.or(earlier.pictures),
            quality: self.quality.or(earlier.quality),
            film: self.film && earlier.film,
            checkpoint_every: self.checkpoint_every.or(earlier.checkpoint_every),
            on_burst: self.on_burst.or(earlier.on_burst),
        }
    }

    /// Applies the settings to the scene.
    pub(crate) fn apply_to(&self, scene: &mut Scene) {
        scene.surface.enabled &= self.surface;
        scene.surface.min_blob = self.min_blob.unwrap_or(scene.surface.min_blob);
        scene.surface.min_neighbours = self.min_neighbours.unwrap_or(scene.surface.min_neighbours);
        if let Some(formats) = &self.formats {
            scene.output.formats = distinct(formats);
        }
        if let Some(pictures) = &self.pictures {
            scene.output.pictures = distinct(pictures);
        }
        if let Some(quality) = self.quality {
            scene.output.quality = quality;
        }
    }

    /// The pictures to draw of a scene to which these settings were applied.
    ///
    /// # Errors
    /// [`RunError::SurfaceRequired`] if pictures of the surface were requested and there is no surface.
    pub(crate) fn pictures_of(&self, scene: &Scene) -> Result<Vec<PictureKind>, RunError> {
        let mut kinds = scene.output.pictures.clone();
        if scene.surface.enabled || !kinds.contains(&PictureKind::Surface) {
            return Ok(kinds);
        }
        if self.pictures.is_some() {
            return Err(RunError::SurfaceRequired);
        }
        kinds.retain(|&kind| kind != PictureKind::Surface);
        Ok(kinds)
    }

    /// Whether pictures were requested, not only suggested by the scene.
    pub(crate) fn requires_pictures(&self) -> bool {
        self.pictures.as_ref().is_some_and(|kinds| !kinds.is_empty())
    }
}

/// Each item once. A repeated format would write the same file twice at the same time.
fn distinct<T: Copy + PartialEq>(items: &[T]) -> Vec<T> {
    items.iter().fold(Vec::new(), |mut found, &item| {
        if !found.contains(&item) {
            found.push(item);
        }
        found
    })
}
