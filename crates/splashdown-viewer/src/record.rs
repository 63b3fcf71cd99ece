//! Keeping what is seen as a sequence of pictures and a film: one picture per frame of the scene, however long
//! it takes.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use splashdown_io::{Film, FilmOptions, FrameWriter, Job, Picture, prepare_folder};

/// Films show at most this many frames per second; a scene with more is shown in slow motion.
const FASTEST_FILM: f32 = 60.0;
/// How fast slow motion is shown.
const SLOW_MOTION_RATE: f32 = 30.0;

/// A recording in the making. Pictures that are written stay whatever happens later.
pub struct Recorder {
    folder: PathBuf,
    /// Width and height of every picture, in pixels.
    size: [u32; 2],
    writer: FrameWriter,
    film: Option<Arc<Film>>,
    frames: u32,
}

impl Recorder {
    /// Begins in a folder that is not there yet; without `ffmpeg` there will be no film, and the second part says so.
    ///
    /// # Errors
    /// A sentence, if nothing can be written.
    pub fn start(name: &Path, size: [u32; 2], frame_rate: f32) -> Result<(Self, Option<String>), String> {
        let folder = unused(name);
        prepare_folder(&folder).map_err(|error| error.to_string())?;
        let rate = if frame_rate > FASTEST_FILM { SLOW_MOTION_RATE } else { frame_rate };
        let pattern = folder.join("picture_%04d.png").display().to_string();
        let options = FilmOptions::new(folder.join("film.mp4"), size[0], size[1], rate.into(), pattern);
        let (film, obstacle) = match Film::start(options) {
            Ok(film) => (Some(Arc::new(film)), None),
            Err(error) => (None, Some(error.to_string())),
        };
        let writer = FrameWriter::start().map_err(|error| error.to_string())?;
        Ok((Self { folder, size, writer, film, frames: 0 }, obstacle))
    }

    /// The size that every picture must have, in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Pictures so far.
    pub fn frames(&self) -> u32 {
        self.frames
    }

    /// Adds a picture: 8-bit RGBA rows from the top, of [`size`](Self::size).
    ///
    /// # Errors
    /// A sentence, if an earlier picture could not be written.
    pub fn add(&mut self, rgba: Vec<u8>) -> Result<(), String> {
        let [width, height] = self.size;
        let picture = Arc::new(Picture { width, height, rgba });
        let mut jobs =
            vec![Job::Png(self.folder.join(format!("picture_{:04}.png", self.frames)), Arc::clone(&picture))];
        jobs.extend(self.film.iter().map(|film| Job::Film(Arc::clone(film), Arc::clone(&picture))));
        self.frames += 1;
        self.writer.submit(jobs).map_err(|error| error.to_string())
    }

    /// Waits for the last picture and the end of the film; says where they are.
    ///
    /// # Errors
    /// A sentence with what could not be written.
    pub fn finish(self) -> Result<String, String> {
        self.writer.finish().map_err(|failure| failure.to_string())?;
        if let Some(film) = &self.film {
            film.finish().map_err(|error| error.to_string())?;
        }
        Ok(format!("{} ({} pictures)", self.folder.display(), self.frames))
    }
}

/// This name, or with the first number that no folder has yet.
fn unused(name: &Path) -> PathBuf {
    let numbered = (2..).map(|number| PathBuf::from(format!("{}-{number}", name.display())));
    std::iter::once(name.to_owned()).chain(numbered).find(|path| !path.exists()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_picture_is_there_and_nothing_is_written_over() {
        let folder = tempfile::tempdir().unwrap();
        let name = folder.path().join("dam-break");
        for round in 0..2 {
            let (mut recorder, obstacle) = Recorder::start(&name, [16, 8], 30.0).unwrap();
            for shade in 0..3 {
                recorder.add(vec![60 * shade; 16 * 8 * 4]).unwrap();
            }
            assert_eq!(recorder.frames(), 3);
            let told = recorder.finish().unwrap();
            let place = if round == 0 { name.clone() } else { folder.path().join("dam-break-2") };
            assert!(told.contains(&place.display().to_string()), "{told}");
            for frame in 0..3 {
                assert!(place.join(format!("picture_{frame:04}.png")).exists());
            }
            // Without ffmpeg it was told why.
            assert!(place.join("film.mp4").exists() || obstacle.is_some());
        }
    }
}
