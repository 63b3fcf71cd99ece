//! Errors of films. The messages contain the command that makes the film later.

use std::path::PathBuf;

/// The reason why a film was not made. A message states that the pictures exist, and contains the command that makes the
/// film from them.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FilmError {
    /// The program does not exist.
    #[error(
        "no film was made: `{}` was not found; install it with `sudo apt install ffmpeg` (Debian, Ubuntu), `brew \
         install ffmpeg` (macOS) or `winget install Gyan.FFmpeg` (Windows). {later}",
        program.display()
    )]
    NotInstalled {
        /// The program.
        program: PathBuf,
        /// A sentence with the command that makes the film.
        later: String,
    },

    /// The program was built without the H.264 encoder.
    #[error(
        "no film was made: `{}` has no encoder libx264 (H.264); install a complete build: `sudo apt install ffmpeg` \
         (Debian, Ubuntu), `brew install ffmpeg` (macOS) or `winget install Gyan.FFmpeg` (Windows). {later}",
        program.display()
    )]
    NoH264 {
        /// The program.
        program: PathBuf,
        /// A sentence with the command that makes the film.
        later: String,
    },

    /// The size or frame rate is not possible.
    #[error(
        "a film of {width} x {height} pixels at {frame_rate} pictures per second is not possible: all must be positive and finite"
    )]
    Options {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// Pictures per second.
        frame_rate: f64,
    },

    /// A picture does not have the size of the film.
    #[error("picture {number} of the film is {} x {} pixels with {bytes} bytes, but the film is {} x {}, RGBA. {later}", given.0, given.1, expected.0, expected.1)]
    PictureSize {
        /// Number of the picture in the film, from 0.
        number: u64,
        /// Its width and height in pixels.
        given: (u32, u32),
        /// Its bytes.
        bytes: usize,
        /// The film's width and height in pixels.
        expected: (u32, u32),
        /// A sentence with the command that makes the film.
        later: String,
    },

    /// No picture was added.
    #[error("no film was made: there are no pictures")]
    Empty,

    /// The program ended early or failed.
    #[error("no film was made: `{}` ended with {status}: {log}. {later}", program.display())]
    Died {
        /// The program.
        program: PathBuf,
        /// Its exit status as text.
        status: String,
        /// The end of its error output.
        log: String,
        /// A sentence with the command that makes the film.
        later: String,
    },

    /// The program accepted no picture, or did not end, within the time limit, and was stopped.
    #[error("no film was made: `{}` did not respond for {seconds} s and was stopped: {log}. {later}", program.display())]
    Stalled {
        /// The program.
        program: PathBuf,
        /// The limit, [`FilmOptions::stall_limit`](crate::FilmOptions::stall_limit).
        seconds: f64,
        /// The end of its error output.
        log: String,
        /// A sentence with the command that makes the film.
        later: String,
    },

    /// The program or its threads could not be started, or the finished film could not be renamed.
    #[error("no film was made: `{}`: {detail}. {later}", path.display())]
    System {
        /// The program or file concerned.
        path: PathBuf,
        /// The message of the operating system.
        detail: String,
        /// A sentence with the command that makes the film.
        later: String,
    },
}
