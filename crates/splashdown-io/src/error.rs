//! Errors. A message says what was given, what is allowed and what to do.

mod film;

pub use film::FilmError;

use std::io;
use std::path::{Path, PathBuf};

/// The errors of this crate's functions.
///
/// The error of the operating system is stored as text and not as a `source()`, so that one message is complete and the
/// value can be cloned: [`crate::FrameWriter`] returns the same failure from every later call.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IoError {
    /// A file or folder could not be written. A file that existed under its name is unchanged.
    #[error("cannot write `{}`: {cause} ({detail}); {}", path.display(), cause.advice())]
    Write {
        /// The requested file or folder, not its temporary name.
        path: PathBuf,
        /// The kind of the cause.
        cause: WriteCause,
        /// The message of the operating system.
        detail: String,
    },

    /// A file could not be opened or read.
    #[error("cannot read `{}`: {detail}", path.display())]
    Read {
        /// The requested file.
        path: PathBuf,
        /// The message of the operating system.
        detail: String,
    },

    /// A file was read, but it is damaged, cut short, or of another format.
    #[error("`{}` is not a usable {format} file: {reason}", path.display())]
    Malformed {
        /// The file that was given.
        path: PathBuf,
        /// The format it was read as, e.g. `PLY`.
        format: &'static str,
        /// What is wrong and, where known, what is allowed.
        reason: String,
    },

    /// A file of particles is complete and contains none, as that of foam before the first splash.
    #[error("`{}` is not a usable {format} file: it contains no particles", path.display())]
    NoParticles {
        /// The file that was given.
        path: PathBuf,
        /// Its format, e.g. `PLY`.
        format: &'static str,
    },

    /// The ending of a file's name is not that of a format for this data.
    #[error(
        "cannot tell the format of `{}`: its name must end in one of {}",
        path.display(),
        allowed.join(", ")
    )]
    UnknownFormat {
        /// The path that was given.
        path: PathBuf,
        /// The allowed endings, with their dots.
        allowed: Vec<&'static str>,
    },

    /// An attribute's array is neither empty nor as long as the positions.
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

    /// A triangle uses a vertex that does not exist.
    #[error(
        "triangle {triangle} uses vertex {index}, but the mesh has {vertices} vertices (numbered from 0)"
    )]
    IndexOutOfRange {
        /// Number of the triangle, from 0.
        triangle: usize,
        /// The vertex number.
        index: u32,
        /// The number of vertices of the mesh.
        vertices: usize,
    },

    /// More particles, vertices or triangles than the 32-bit integers of the formats can count.
    #[error("{given} {what} are too many: at most {limit} are possible; split them into several files")]
    TooMany {
        /// `particles`, `vertices` or `triangles`.
        what: &'static str,
        /// Their number.
        given: usize,
        /// The largest allowed number.
        limit: usize,
    },

    /// The frames of an animated scene need more than a file of its format can hold. The file contains the first of them.
    #[error(
        "`{}` {}: a GLB file holds at most 4 GB. Use the format usd for all {last} frames, or fewer frames",
        path.display(),
        frame.map_or_else(|| "contains no frame".to_owned(), |frame| format!("ends with frame {frame}"))
    )]
    TooLong {
        /// The file.
        path: PathBuf,
        /// The last frame in it.
        frame: Option<u32>,
        /// The last frame that was given.
        last: u32,
    },

    /// The number of a picture's bytes does not match its size.
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

    /// The number of values in a row of a table is not that of its columns.
    #[error("a row of `{}` has {given} numbers for {expected} columns: give one for each, NaN if it is missing", path.display())]
    Columns {
        /// The table's file.
        path: PathBuf,
        /// Numbers in the row.
        given: usize,
        /// Columns of the table.
        expected: usize,
    },

    /// The background writer ended early (it panicked, or could not be started).
    #[error("the background writer stopped: {reason}; the files written before are complete")]
    WriterStopped {
        /// The reason.
        reason: String,
    },

    /// The film could not be made; the pictures exist.
    #[error(transparent)]
    Film(#[from] FilmError),
}

/// Why a file could not be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum WriteCause {
    /// No space left, or the user's quota is used up.
    #[error("the disk is full")]
    DiskFull,
    /// The user has no permission to write there.
    #[error("permission denied")]
    Permission,
    /// The file system is mounted read-only.
    #[error("the file system is read-only")]
    ReadOnly,
    /// The folder does not exist or was removed.
    #[error("its folder does not exist")]
    MissingFolder,
    /// A part of the path is a file instead of a folder.
    #[error("a part of the path is a file, not a folder")]
    NotAFolder,
    /// The path is an existing folder, but a file is to be written.
    #[error("a folder with this name exists")]
    IsAFolder,
    /// The file would exceed the size limit of the file system.
    #[error("the file is too large for this file system or for the limit of this process (ulimit -f)")]
    TooLarge,
    /// Any other cause; the message of the system describes it.
    #[error("the system reports an error")]
    Other,
}

impl WriteCause {
    /// The cause of an error of the operating system.
    #[must_use]
    pub fn of(error: &io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => Self::DiskFull,
            io::ErrorKind::PermissionDenied => Self::Permission,
            io::ErrorKind::ReadOnlyFilesystem => Self::ReadOnly,
            io::ErrorKind::NotFound => Self::MissingFolder,
            // `create_dir_all` reports `AlreadyExists` if a file has the folder's name.
            io::ErrorKind::NotADirectory | io::ErrorKind::AlreadyExists => Self::NotAFolder,
            io::ErrorKind::IsADirectory => Self::IsAFolder,
            io::ErrorKind::FileTooLarge => Self::TooLarge,
            _ => Self::Other,
        }
    }

    /// What the user can do, as the end of a sentence.
    #[must_use]
    pub fn advice(self) -> &'static str {
        match self {
            Self::DiskFull => "free some space or choose another output folder",
            Self::Permission => "choose a writable output folder, or change its permissions",
            Self::ReadOnly => "choose an output folder on another file system",
            Self::MissingFolder => "create the folder, or check whether it was removed or its disk unplugged",
            Self::NotAFolder => "choose another output folder, or rename the file",
            Self::IsAFolder => "rename the folder, or choose another name",
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

    /// `path` was read as `format`, but is not valid.
    pub(crate) fn malformed(path: &Path, format: &'static str, reason: impl Into<String>) -> Self {
        Self::Malformed { path: path.to_owned(), format, reason: reason.into() }
    }
}

impl From<IoError> for io::Error {
    /// An error of kind `InvalidInput`.
    fn from(error: IoError) -> Self {
        Self::new(io::ErrorKind::InvalidInput, error)
    }
}
