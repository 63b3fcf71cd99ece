//! Why there is no film, and how to get one all the same.

use std::path::PathBuf;

/// Why a film was not made. Every message says that the pictures are there and how to make the film from them.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FilmError {
    /// There is no such program.
    #[error(
        "no film was made: `{}` was not found; install it with `sudo apt install ffmpeg` (Debian, Ubuntu), `brew \
         install ffmpeg` (macOS) or `winget install Gyan.FFmpeg` (Windows). {later}",
        program.display()
    )]
    NotInstalled {
        /// The program that was looked for.
        program: PathBuf,
        /// The sentence with the command that makes the film later.
        later: String,
    },

    /// The program is there but was built without the H.264 encoder.
    #[error(
        "no film was made: `{}` has no encoder libx264 (H.264); install a complete build: `sudo apt install ffmpeg` \
         (Debian, Ubuntu), `brew install ffmpeg` (macOS) or `winget install Gyan.FFmpeg` (Windows). {later}",
        program.display()
    )]
    NoH264 {
        /// The program that was asked.
        program: PathBuf,
        /// The sentence with the command that makes the film later.
        later: String,
    },

    /// The size or rate given is not possible.
    #[error(
        "a film of {width} x {height} pixels at {frame_rate} pictures a second is not possible: all must be positive and finite"
    )]
    Options {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// Pictures per second.
        frame_rate: f64,
    },

    /// A picture of another size than the film's.
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
        /// The sentence with the command that makes the film later.
        later: String,
    },

    /// Not a single picture was added.
    #[error("no film was made: it was given no pictures")]
    Empty,

    /// The program ended before its time or with a failure.
    #[error("no film was made: `{}` ended with {status}: {log}. {later}", program.display())]
    Died {
        /// The program.
        program: PathBuf,
        /// Its exit status in words.
        status: String,
        /// The end of what it said.
        log: String,
        /// The sentence with the command that makes the film later.
        later: String,
    },

    /// The program took nothing, or did not end, for longer than the limit, and was stopped.
    #[error("no film was made: `{}` did not go on for {seconds} s and was stopped: {log}. {later}", program.display())]
    Stalled {
        /// The program.
        program: PathBuf,
        /// The limit, [`super::FilmOptions::stall_limit`].
        seconds: f64,
        /// The end of what it said.
        log: String,
        /// The sentence with the command that makes the film later.
        later: String,
    },

    /// The program or its threads could not be started, or the finished film could not be given its name.
    #[error("no film was made: `{}`: {detail}. {later}", path.display())]
    System {
        /// The program or file concerned.
        path: PathBuf,
        /// The system's own words.
        detail: String,
        /// The sentence with the command that makes the film later.
        later: String,
    },
}
