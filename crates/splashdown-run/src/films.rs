//! Films of the pictures of a run.

use std::path::PathBuf;
use std::sync::Arc;

use splashdown::scene::{Output, PictureKind, Scene};
use splashdown_io::{Film, FilmOptions, FrameWriter, IoError, Job, WrittenFile, picture};

use crate::{Reporter, RunFolder};

/// Films show at most this many frames per second.
const MAX_FRAME_RATE: f32 = 60.0;
/// The frame rate of the films of scenes with a higher frame rate. These films are in slow motion.
const SLOW_MOTION_RATE: f32 = 30.0;

/// The frame rate of the film of a scene.
pub fn frame_rate(scene_frame_rate: f32) -> f32 {
    if scene_frame_rate > MAX_FRAME_RATE { SLOW_MOTION_RATE } else { scene_frame_rate }
}

/// Why pictures of this size cannot be made into a film.
pub fn size_problem([width, height]: [u32; 2]) -> Option<String> {
    let limit = Output::MAX_FILM_SIDE;
    (width.max(height) > limit).then(|| {
        format!(
            "no film was made: its pictures have {width} x {height} pixels, and a film has at most {limit} a side; draw \
             smaller pictures for a film"
        )
    })
}

/// Whether the encoder of films is installed.
pub fn can_encode() -> bool {
    Film::can_encode(std::path::Path::new("ffmpeg"))
}

/// Starts a film per kind of picture. Failures are returned as messages with the command that makes the film later.
pub(crate) fn start(
    scene: &Scene,
    kinds: &[PictureKind],
    folder: &RunFolder,
) -> (Vec<Arc<Film>>, Vec<String>) {
    let [width, height] = scene.output.picture_size;
    let rate = frame_rate(scene.frame_rate);
    let mut films = Vec::new();
    let mut failures = Vec::new();
    for &kind in kinds {
        let options =
            FilmOptions::new(folder.film(kind), width, height, rate.into(), folder.picture_pattern(kind));
        let by_hand = options.command_by_hand();
        match Film::start(options) {
            Ok(film) => films.push(Arc::new(film)),
            Err(error) if failures.is_empty() => failures.push(error.to_string()),
            Err(_) => failures.push(format!("and for the other pictures: {by_hand}")),
        }
    }
    (films, failures)
}

/// Adds the existing pictures of frames 0 to `last` to the films. Returns the number of missing pictures.
///
/// # Errors
/// The writer's first failure.
pub(crate) fn add_existing(
    films: &[Arc<Film>],
    kinds: &[PictureKind],
    folder: &RunFolder,
    last: u32,
    writer: &FrameWriter,
) -> Result<u32, IoError> {
    let mut missing = 0;
    for frame in 0..=last {
        for (film, &kind) in films.iter().zip(kinds) {
            let size = [film.options().width, film.options().height];
            match picture::read_png(&folder.picture(kind, frame)) {
                Ok(picture) if [picture.width, picture.height] == size => {
                    writer.submit(vec![Job::Film(Arc::clone(film), Arc::new(picture))])?;
                }
                _ => missing += 1,
            }
        }
    }
    Ok(missing)
}

/// Makes a film of these pictures, shown `repeats` times.
///
/// # Errors
/// Why there is no film, with the command that makes it from the pictures.
pub(crate) fn of_pictures(options: FilmOptions, pictures: &[PathBuf], repeats: u32) -> Result<(), String> {
    let film = Film::start(options).map_err(|error| error.to_string())?;
    for path in (0..repeats).flat_map(|_| pictures) {
        let picture = picture::read_png(path).map_err(|error| error.to_string())?;
        film.push(&Arc::new(picture));
    }
    film.finish().map(|_| ()).map_err(|error| error.to_string())
}

/// Completes the films. A failure is only a warning: the pictures exist and the film can be made from them.
pub(crate) fn finish(films: &[Arc<Film>], reporter: &mut dyn Reporter) -> Vec<WrittenFile> {
    let mut done = Vec::new();
    for film in films {
        match film.finish() {
            Ok(bytes) => done.push(WrittenFile { path: film.options().path.clone(), bytes }),
            Err(error) => reporter.warning(&error.to_string()),
        }
    }
    done
}

#[cfg(test)]
mod tests {
    use super::{frame_rate, size_problem};

    #[test]
    fn large_pictures_have_no_film() {
        assert_eq!(size_problem([8192, 8192]), None);
        assert!(size_problem([16, 9000]).is_some_and(|problem| problem.contains("16 x 9000")));
    }

    #[test]
    fn fast_scenes_are_shown_in_slow_motion() {
        assert_eq!([24.0, 60.0, 120.0].map(frame_rate), [24.0, 60.0, 30.0]);
    }
}
