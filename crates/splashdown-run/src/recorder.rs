//! Recording pictures from any source as a numbered sequence and a film.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use splashdown_io::{Film, FilmOptions, FrameWriter, Job, Picture, prepare_folder};

use crate::{RunError, export, films};

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
        let mut recorder = Self::without_film(name, size)?;
        let (film, failure) = match Film::start(recorder.film_options(film_rate)) {
            Ok(film) => (Some(Arc::new(film)), None),
            Err(error) => (None, Some(error.to_string())),
        };
        recorder.film = film;
        Ok((recorder, failure))
    }

    /// As [`start`](Self::start), without a film. [`finish_with_film`](Self::finish_with_film) makes one at the end.
    ///
    /// # Errors
    /// As [`start`](Self::start).
    pub fn without_film(name: &Path, size: [u32; 2]) -> Result<Self, RunError> {
        let folder = export::unused_folder(name);
        prepare_folder(&folder)?;
        Ok(Self { folder, size, writer: FrameWriter::start()?, film: None, frames: 0 })
    }

    fn film_options(&self, rate: f32) -> FilmOptions {
        let pattern = self.folder.join("picture_%04d.png").display().to_string();
        FilmOptions::new(self.folder.join("film.mp4"), self.size[0], self.size[1], rate.into(), pattern)
    }

    fn picture(&self, number: u32) -> PathBuf {
        self.folder.join(format!("picture_{number:04}.png"))
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
        let mut jobs = vec![Job::Png(self.picture(self.frames), Arc::clone(&picture))];
        jobs.extend(self.film.iter().map(|film| Job::Film(Arc::clone(film), Arc::clone(&picture))));
        self.frames += 1;
        Ok(self.writer.submit(jobs)?)
    }

    /// Waits for the last picture, and makes a film that shows all pictures `repeats` times, from the files. The program that
    /// encodes it is started now, so that Ctrl-C, which ends it as well, may stop the drawing of pictures before. Returns
    /// why there is no film, if there is none.
    ///
    /// # Errors
    /// [`RunError::Io`] with the picture that could not be written.
    pub fn finish_with_film(mut self, rate: f32, repeats: u32) -> Result<Option<String>, RunError> {
        let options = self.film_options(rate);
        let pictures: Vec<PathBuf> = (0..self.frames).map(|number| self.picture(number)).collect();
        self.film = None;
        self.finish()?;
        Ok(films::of_pictures(options, &pictures, repeats).err())
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

    #[test]
    fn a_film_at_the_end_shows_the_pictures_several_times() {
        let folder = tempfile::tempdir().unwrap();
        let film = |name: &str, repeats: u32| {
            let mut recorder = Recorder::without_film(&folder.path().join(name), [64, 48]).unwrap();
            for number in 0..4_u32 {
                // Noise, so that the size of the film grows with the number of its pictures.
                let noise = |i: u32| ((i + 12_288 * number).wrapping_mul(2_654_435_761) >> 24) as u8;
                recorder.add((0..64 * 48 * 4).map(noise).collect()).unwrap();
            }
            let failure = recorder.finish_with_film(30.0, repeats).unwrap();
            let size = std::fs::metadata(folder.path().join(name).join("film.mp4")).map(|data| data.len());
            assert!(size.is_ok() != failure.is_some(), "{failure:?}");
            assert!(folder.path().join(name).join("picture_0003.png").exists());
            size.ok()
        };
        if let (Some(once), Some(often)) = (film("once", 1), film("often", 20)) {
            assert!(often > 2 * once, "{once} and {often} bytes");
        }
    }
}
