//! What can go wrong with a file, in words that say what was given, what is allowed and what to do.

mod film;

pub use film::FilmError;

use std::io;
use std::path::{Path, PathBuf};

/// Everything this crate's functions can fail with.
///
/// The system's own error is kept as text and not as a `source()`: one message carries the whole story, and the
/// value can be cloned, so that [`crate::FrameWriter`] can report the same failure to every later call.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IoError {
    /// A file or folder could not be written. Nothing is left under its final name that was not there before.
    #[error("cannot write `{}`: {cause} ({detail}); {}", path.display(), cause.advice())]
    Write {
        /// The file or folder that was asked for (not its temporary name).
        path: PathBuf,
        /// The reason in one of the kinds a caller can act on.
        cause: WriteCause,
        /// The system's own words.
        detail: String,
    },

    /// A file could not be opened or read.
    #[error("cannot read `{}`: {detail}", path.display())]
    Read {
        /// The file that was asked for.
        path: PathBuf,
        /// The system's own words.
        detail: String,
    },

    /// A file was read, but it is broken, cut short, or another format.
    #[error("`{}` is not a usable {format} file: {reason}", path.display())]
    Malformed {
        /// The file that was given.
        path: PathBuf,
        /// The format it was read as, e.g. `PLY`.
        format: &'static str,
        /// What is wrong and, where known, what would be right.
        reason: String,
    },

    /// The ending of a file's name does not name a format that can hold this data.
    #[error(
        "cannot tell the format of `{}`: its name must end in one of {}",
        path.display(),
        allowed.join(", ")
    )]
    UnknownFormat {
        /// The path that was given.
        path: PathBuf,
        /// The endings that are allowed, with their dots.
        allowed: &'static [&'static str],
    },

    /// An attribute's array is as long as neither the positions nor zero.
    #[error(
        "`{attribute}` has {given} entries for {expected} {owner}: give one for each, or an empty array to leave \
         the attribute out"
    )]
    Length {
        /// The attribute's name as in [`crate::Particles`] or [`crate::Mesh`].
        attribute: String,
        /// Its length.
        given: usize,
        /// The number of particles or vertices.
        expected: usize,
        /// `particles` or `vertices`.
        owner: &'static str,
    },

    /// A triangle names a vertex that does not exist.
    #[error(
        "triangle {triangle} uses vertex {index}, but the mesh has {vertices} vertices (numbered from 0)"
    )]
    IndexOutOfRange {
        /// Number of the triangle, from 0.
        triangle: usize,
        /// The vertex it names.
        index: u32,
        /// The number of vertices there are.
        vertices: usize,
    },

    /// More particles, vertices or triangles than the 32-bit numbers of the formats can count.
    #[error("{given} {what} are too many: at most {limit} can be counted; split them")]
    TooMany {
        /// `particles`, `vertices` or `triangles`.
        what: &'static str,
        /// How many were given.
        given: usize,
        /// The most that are allowed.
        limit: usize,
    },

    /// A picture's bytes do not fit its size.
    #[error("a picture of {width} x {height} pixels needs {expected} bytes (RGBA, 8 bits each), got {given}")]
    PictureSize {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// width * height * 4.
        expected: u64,
        /// The number of bytes given.
        given: u64,
    },

    /// A row of a table has more or fewer numbers than the table has columns.
    #[error("a row of `{}` has {given} numbers for {expected} columns: give one for each, NaN for none", path.display())]
    Columns {
        /// The table's file.
        path: PathBuf,
        /// Numbers in the row.
        given: usize,
        /// Columns of the table.
        expected: usize,
    },

    /// The background writer ended before its work was done (it panicked, or could not be started).
    #[error("the background writer stopped: {reason}; the files written before are complete")]
    WriterStopped {
        /// What is known about it.
        reason: String,
    },

    /// The film could not be made; the pictures are still there.
    #[error(transparent)]
    Film(#[from] FilmError),
}

/// Why a file could not be written, in the kinds a caller or user can act on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum WriteCause {
    /// No space left, or the user's quota is used up.
    #[error("the disk is full")]
    DiskFull,
    /// The user may not write there.
    #[error("permission denied")]
    Permission,
    /// The whole file system is mounted read-only.
    #[error("the file system is read-only")]
    ReadOnly,
    /// The folder does not exist (any more).
    #[error("its folder does not exist")]
    MissingFolder,
    /// A part of the path that must be a folder is a file.
    #[error("a part of the path is a file, not a folder")]
    NotAFolder,
    /// The path itself is a folder where a file should be written.
    #[error("a folder of this name is in the way")]
    IsAFolder,
    /// The file is larger than the file system allows.
    #[error("the file is too large for this file system")]
    TooLarge,
    /// Anything else; the detail in brackets says what.
    #[error("the system reports an error")]
    Other,
}

impl WriteCause {
    /// Sorts a system error into a cause.
    #[must_use]
    pub fn of(error: &io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => Self::DiskFull,
            io::ErrorKind::PermissionDenied => Self::Permission,
            io::ErrorKind::ReadOnlyFilesystem => Self::ReadOnly,
            io::ErrorKind::NotFound => Self::MissingFolder,
            // `AlreadyExists` is what `create_dir_all` reports where a file has the folder's name.
            io::ErrorKind::NotADirectory | io::ErrorKind::AlreadyExists => Self::NotAFolder,
            io::ErrorKind::IsADirectory => Self::IsAFolder,
            io::ErrorKind::FileTooLarge => Self::TooLarge,
            _ => Self::Other,
        }
    }

    /// What the user can do about it, as the end of a sentence.
    #[must_use]
    pub fn advice(self) -> &'static str {
        match self {
            Self::DiskFull => "free some space or choose another output folder",
            Self::Permission => "choose an output folder you may write to, or change its permissions",
            Self::ReadOnly => "choose an output folder on another file system",
            Self::MissingFolder => {
                "create the folder, or check whether it was removed or unplugged meanwhile"
            }
            Self::NotAFolder => "choose another output folder, or move the file out of the way",
            Self::IsAFolder => "move the folder out of the way, or choose another name",
            Self::TooLarge => "choose an output folder on another file system, or write fewer particles",
            Self::Other => "check the path and the disk",
        }
    }
}

impl IoError {
    /// A failure to write `path`.
    pub(crate) fn write(path: &Path, error: &io::Error) -> Self {
        Self::Write { path: path.to_owned(), cause: WriteCause::of(error), detail: error.to_string() }
    }

    /// A failure to read `path`.
    pub(crate) fn read(path: &Path, error: &io::Error) -> Self {
        Self::Read { path: path.to_owned(), detail: error.to_string() }
    }

    /// `path` was read as `format` and is not one.
    pub(crate) fn malformed(path: &Path, format: &'static str, reason: impl Into<String>) -> Self {
        Self::Malformed { path: path.to_owned(), format, reason: reason.into() }
    }
}
