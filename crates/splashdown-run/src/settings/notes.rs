//! The settings of a run and the state of its files, as stored in its checkpoints (entry `notes.json`). A resumed
//! run continues with the same output.

use serde::{Deserialize, Serialize};
use splashdown::Checkpoint;
use splashdown::error::CheckpointError;
use splashdown::scene::{Choice, Format, OnBurst, PictureKind, PictureQuality};
use splashdown::surface::MAX_BLOB;

use super::RunSettings;

/// The entry's content. Choices are stored by their scene-file words.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct Notes {
    device: Option<String>,
    frames: Option<u32>,
    formats: Option<Vec<String>>,
    no_surface: bool,
    min_blob: Option<u32>,
    min_neighbours: Option<u32>,
    pictures: Option<Vec<String>>,
    no_pictures: bool,
    quality: Option<String>,
    no_film: bool,
    checkpoint_every: Option<u32>,
    on_burst: Option<String>,
    /// Digits of the frame numbers in file names.
    pub digits: Option<usize>,
    /// The first frame written with these formats.
    pub since: u32,
    /// Bytes in each table at the checkpoint: probes, then bodies, in the order of the scene.
    #[serde(alias = "probe_bytes")]
    pub table_bytes: Vec<u64>,
}

impl Notes {
    /// The notes of a run with these settings.
    pub fn new(settings: &RunSettings) -> Self {
        let no_pictures = settings.pictures.as_ref().is_some_and(Vec::is_empty);
        let pictures = settings.pictures.as_ref().filter(|kinds| !kinds.is_empty());
        Self {
            device: settings.device.as_ref().map(ToString::to_string),
            frames: settings.frames,
            formats: settings.formats.as_deref().map(words),
            no_surface: !settings.surface,
            min_blob: settings.min_blob,
            min_neighbours: settings.min_neighbours,
            pictures: pictures.map(|kinds| words(kinds)),
            no_pictures,
            quality: settings.quality.map(|quality| quality.name().to_owned()),
            no_film: !settings.film,
            checkpoint_every: settings.checkpoint_every,
            on_burst: settings.on_burst.map(|choice| choice.name().to_owned()),
            ..Self::default()
        }
    }

    /// The notes in a checkpoint. A checkpoint of the window or of another program has none, which gives the defaults.
    ///
    /// # Errors
    /// [`CheckpointError::Malformed`] for values that no run stores.
    pub fn in_checkpoint(checkpoint: &Checkpoint) -> Result<Self, CheckpointError> {
        let Some(notes) = checkpoint.notes() else { return Ok(Self::default()) };
        let checked = serde_json::from_str(notes).map_err(|error| error.to_string()).and_then(Self::checked);
        checked.map_err(|reason| CheckpointError::Malformed(format!("its entry `notes.json`: {reason}")))
    }

    /// The notes in a report; `None` for values that no run stores.
    pub fn in_report(notes: serde_json::Value) -> Option<Self> {
        serde_json::from_value(notes).ok().and_then(|notes: Self| notes.checked().ok())
    }

    /// The settings.
    pub fn settings(&self) -> RunSettings {
        let pictures = self.pictures.as_deref().map(choices::<PictureKind>);
        RunSettings {
            // Parsing cannot fail: an unknown word is the name of an adapter.
            device: self.device.as_ref().map(|word| word.parse().unwrap_or_default()),
            frames: self.frames,
            formats: self.formats.as_deref().map(choices::<Format>),
            surface: !self.no_surface,
            min_blob: self.min_blob,
            min_neighbours: self.min_neighbours,
            pictures: if self.no_pictures { Some(Vec::new()) } else { pictures },
            quality: self.quality.as_deref().and_then(PictureQuality::from_name),
            film: !self.no_film,
            checkpoint_every: self.checkpoint_every,
            on_burst: self.on_burst.as_deref().and_then(OnBurst::from_name),
        }
    }

    /// As the text of the entry.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    fn checked(self) -> Result<Self, String> {
        let numbers = [("frames", self.frames), ("checkpoint_every", self.checkpoint_every)];
        for (name, number) in numbers {
            if number.is_some_and(|number| !(1..=1_000_000).contains(&number)) {
                return Err(format!("`{name}` is not between 1 and 1000000"));
            }
        }
        for (name, limit) in [("min_blob", self.min_blob), ("min_neighbours", self.min_neighbours)] {
            if limit.is_some_and(|limit| limit > MAX_BLOB) {
                return Err(format!("`{name}` is above {MAX_BLOB}"));
            }
        }
        if self.digits.is_some_and(|digits| !(4..=10).contains(&digits)) {
            return Err("`digits` is not between 4 and 10".to_owned());
        }
        let formats = self.formats.iter().flatten().filter(|word| Format::from_name(word).is_none());
        let pictures = self.pictures.iter().flatten().filter(|word| PictureKind::from_name(word).is_none());
        let quality = self.quality.iter().filter(|word| PictureQuality::from_name(word).is_none());
        let reaction = self.on_burst.iter().filter(|word| OnBurst::from_name(word).is_none());
        match formats.chain(pictures).chain(quality).chain(reaction).next() {
            Some(word) => Err(format!("it requests {word:?}, which this program cannot write")),
            None => Ok(self),
        }
    }
}

fn words<T: Choice>(list: &[T]) -> Vec<String> {
    list.iter().map(|choice| choice.name().to_owned()).collect()
}

/// Unknown words do not occur: `checked` has refused them.
fn choices<T: Choice>(words: &[String]) -> Vec<T> {
    words.iter().filter_map(|word| T::from_name(word)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use splashdown::Device;

    #[test]
    fn settings_are_restored_from_notes() {
        let settings = [
            RunSettings::default(),
            RunSettings { pictures: Some(Vec::new()), surface: false, ..RunSettings::default() },
            RunSettings {
                device: Some(Device::Cpu),
                frames: Some(7),
                min_blob: Some(0),
                min_neighbours: Some(4),
                formats: Some(vec![Format::Vtu, Format::Ply]),
                pictures: Some(vec![PictureKind::Particles]),
                film: false,
                checkpoint_every: Some(3),
                on_burst: Some(OnBurst::Warn),
                ..RunSettings::default()
            },
        ];
        for settings in settings {
            let notes = Notes::new(&settings);
            let read: Notes = serde_json::from_str(&notes.to_json()).unwrap();
            assert_eq!(read, notes);
            assert_eq!(read.settings(), settings);
        }
    }
}
