//! Recording pictures from any source as a numbered sequence and a film.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use splashdown_io::{Film, FilmOptions, FrameWriter, Job, Picture, prepare_folder};

use crate::{RunError, export};

/// A recording in progress. Pictures already written remain if a later one fails.
#[derive(Debug)]
pub struct Recorder {
    folder: PathBuf,
    /// Width and height of every picture, in pixels.
    size: [u32; 2],
    writer: FrameWriter,
    film: Option<Arc<Film>>,
    frames: u32,
}

impl Recorder {
    /// Starts in a new folder of this name, numbered if the name is in use. `film_rate`: frames per
    /// second of the film, see [`films::frame_rate`](crate::films::frame_rate). If the film cannot be started, for example without `ffmpeg`, the second value is the
    /// reason.
    ///
    /// # Errors
    /// [`RunError::Io`] if nothing can be written.
    pub fn start(name: &Path, size: [u32; 2], film_rate: f32) -> Result<(Self, Option<String>), RunError> {
        let folder = export::unused_folder(name);
        prepare_folder(&folder)?;
        let pattern = folder.join("picture_%04d.png").display().to_string();
        let options = FilmOptions::new(folder.join("film.mp4"), size[0], size[1], film_rate.into(), pattern);
        let (film, failure) = match Film::start(options) {
            Ok(film) => (Some(Arc::new(film)), None),
            Err(error) => (None, Some(error.to_string())),
        };
        Ok((Self { folder, size, writer: FrameWriter::start()?, film, frames: 0 }, failure))
    }

    /// The size that every picture must have, in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Number of pictures so far.
    pub fn frames(&self) -> u32 {
        self.frames
    }

    /// The folder of the pictures and the film.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Adds a picture: 8-bit RGBA rows from the top, of [`size`](Self::size).
    ///
    /// # Errors
    /// [`RunError::Io`] if an earlier picture could not be written.
    pub fn add(&mut self, rgba: Vec<u8>) -> Result<(), RunError> {
        let [width, height] = self.size;
        let picture = Arc::new(Picture { width, height, rgba });
        let mut jobs =
            vec![Job::Png(self.folder.join(format!("picture_{:04}.png", self.frames)), Arc::clone(&picture))];
        jobs.extend(self.film.iter().map(|film| Job::Film(Arc::clone(film), Arc::clone(&picture))));
        self.frames += 1;
        Ok(self.writer.submit(jobs)?)
    }

    /// Waits for the last picture and the end of the film.
    ///
    /// # Errors
    /// [`RunError::Io`] with what could not be written.
    pub fn finish(self) -> Result<(), RunError> {
        self.writer.finish().map_err(|failure| failure.error)?;
        if let Some(film) = &self.film {
            film.finish().map_err(splashdown_io::IoError::from)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_picture_is_written_and_nothing_is_overwritten() {
        let folder = tempfile::tempdir().unwrap();
        let name = folder.path().join("dam-break");
        for recording in 0..2 {
            let (mut recorder, failure) = Recorder::start(&name, [16, 8], 30.0).unwrap();
            for shade in 0..3 {
                recorder.add(vec![60 * shade; 16 * 8 * 4]).unwrap();
            }
            assert_eq!(recorder.frames(), 3);
            let expected = if recording == 0 { name.clone() } else { folder.path().join("dam-break-2") };
            assert_eq!(recorder.folder(), expected);
            recorder.finish().unwrap();
            for frame in 0..3 {
                assert!(expected.join(format!("picture_{frame:04}.png")).exists());
            }
            // Without ffmpeg there is no film but a reason.
            assert!(expected.join("film.mp4").exists() || failure.is_some());
        }
    }
}
