//! What was asked of a run: it is kept in its checkpoints, so that going on writes what was written before.

use serde::{Deserialize, Serialize};
use splashdown::scene::{Choice, Format, PictureKind, Scene};
use splashdown::{Checkpoint, CheckpointError, Device};

use crate::args::RunArguments;
use crate::exit::{Exit, Failure};

/// The command line's wishes, by their words.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Wishes {
    /// Where to simulate.
    pub device: Option<String>,
    /// Frames after the initial one.
    pub frames: Option<u32>,
    /// Formats instead of the scene's.
    pub formats: Option<Vec<String>>,
    /// No meshes.
    pub no_surface: bool,
    /// Pictures instead of the scene's.
    pub pictures: Option<Vec<String>>,
    /// No pictures.
    pub no_pictures: bool,
    /// No film.
    pub no_film: bool,
    /// Frames between two checkpoints.
    pub checkpoint_every: Option<u32>,
    /// Digits of the frames' numbers in the names of files.
    pub digits: Option<usize>,
    /// The first frame that was written as is asked here.
    pub since: u32,
    /// Bytes in the files of the probes, in the order of the scene, at the checkpoint.
    pub probe_bytes: Vec<u64>,
}

impl Wishes {
    /// Those of a command line.
    ///
    /// # Errors
    /// [`Exit::Usage`] for formats that exclude one another.
    pub fn of(arguments: &RunArguments) -> Result<Self, Failure> {
        let formats = match &arguments.formats {
            Some(formats) if formats.contains(&None) && formats.iter().any(Option::is_some) => {
                let message = "--formats: `none` stands alone; leave it out to write the others";
                return Err(Failure::new(Exit::Usage, message));
            }
            formats => formats.as_ref().map(|formats| words(formats.iter().flatten().copied())),
        };
        Ok(Self {
            device: arguments.device.as_ref().map(Device::to_string),
            frames: arguments.frames,
            formats,
            no_surface: arguments.no_surface,
            pictures: arguments.pictures.as_ref().map(|pictures| words(pictures.iter().copied())),
            no_pictures: arguments.no_pictures,
            no_film: arguments.no_film,
            checkpoint_every: arguments.checkpoint_every,
            ..Self::default()
        })
    }

    /// Those in a checkpoint; none where no command line made it.
    ///
    /// # Errors
    /// [`CheckpointError::Malformed`] for what no command line can have asked for.
    pub fn in_checkpoint(checkpoint: &Checkpoint) -> Result<Self, CheckpointError> {
        let Some(notes) = checkpoint.notes() else { return Ok(Self::default()) };
        let checked = serde_json::from_str(notes).map_err(|error| error.to_string()).and_then(Self::checked);
        checked.map_err(|reason| CheckpointError::Malformed(format!("its entry `notes.json`: {reason}")))
    }

    fn checked(self) -> Result<Self, String> {
        let numbers = [("frames", self.frames), ("checkpoint_every", self.checkpoint_every)];
        for (name, number) in numbers {
            if number.is_some_and(|number| !(1..=1_000_000).contains(&number)) {
                return Err(format!("`{name}` is not between 1 and 1000000"));
            }
        }
        if self.digits.is_some_and(|digits| !(4..=10).contains(&digits)) {
            return Err("`digits` is not between 4 and 10".to_owned());
        }
        let formats = self.formats.iter().flatten().filter(|word| Format::from_name(word).is_none());
        let pictures = self.pictures.iter().flatten().filter(|word| PictureKind::from_name(word).is_none());
        match formats.chain(pictures).next() {
            Some(word) => Err(format!("it asks for {word:?}, which this program cannot write")),
            None => Ok(self),
        }
    }

    /// Those of the run that goes on, where this command line has none of its own.
    pub fn or(self, before: Self) -> Self {
        Self {
            device: self.device.or(before.device),
            frames: self.frames.or(before.frames),
            formats: self.formats.or(before.formats),
            no_surface: self.no_surface || before.no_surface,
            no_pictures: self.no_pictures || before.no_pictures && self.pictures.is_none(),
            pictures: self.pictures.or(before.pictures),
            no_film: self.no_film || before.no_film,
            checkpoint_every: self.checkpoint_every.or(before.checkpoint_every),
            digits: before.digits,
            since: before.since,
            probe_bytes: before.probe_bytes,
        }
    }

    /// Where to simulate.
    pub fn device(&self) -> Device {
        // Every word is a device: at worst the name of an adapter that is not there.
        self.device.as_ref().map_or(Device::Auto, |word| word.parse().unwrap_or_default())
    }

    /// Puts them into a scene.
    pub fn change(&self, scene: &mut Scene) {
        scene.surface.enabled &= !self.no_surface;
        if let Some(formats) = &self.formats {
            scene.output.formats = choices(formats);
        }
        if let Some(pictures) = &self.pictures {
            scene.output.pictures = choices(pictures);
        }
    }

    /// The pictures to draw; those of the surface need one.
    ///
    /// # Errors
    /// [`Exit::Usage`] where they were asked for and there is no surface.
    pub fn pictures(&self, scene: &Scene) -> Result<Vec<PictureKind>, Failure> {
        let mut kinds = if self.no_pictures { Vec::new() } else { scene.output.pictures.clone() };
        if scene.surface.enabled || !kinds.contains(&PictureKind::Surface) {
            return Ok(kinds);
        }
        if self.pictures.is_some() {
            let message = "pictures of the surface need a surface: leave out --no-surface (or surface.enabled = false in the \
                           scene), or draw --pictures particles";
            return Err(Failure::new(Exit::Usage, message));
        }
        kinds.retain(|&kind| kind != PictureKind::Surface);
        Ok(kinds)
    }
}

fn words<T: Choice>(list: impl Iterator<Item = T>) -> Vec<String> {
    list.map(|choice| choice.name().to_owned()).collect()
}

/// A file that is asked for twice is written once: two writers of one name would race.
fn choices<T: Choice + PartialEq>(words: &[String]) -> Vec<T> {
    words.iter().filter_map(|word| T::from_name(word)).fold(Vec::new(), |mut found, item| {
        if !found.contains(&item) {
            found.push(item);
        }
        found
    })
}
