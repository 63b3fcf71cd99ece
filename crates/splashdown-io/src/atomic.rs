//! A file is complete or absent: it is written under a temporary name in the same folder and then renamed.
//!
//! A reader that watches the folder (ParaView reloading a series, a script, the next stage of a pipeline) never
//! sees half a frame, and a run that is killed or meets a full disk leaves every earlier frame as it was. What is
//! promised is this, not survival of a power cut: the data is not forced to the disk, which would make each frame
//! wait for it.
//!
//! *Why not the `tempfile` crate:* it makes files that only their owner can read, as temporary files should be; an
//! output file has the user's usual permissions.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use crate::error::IoError;

/// Large enough that a frame takes few system calls, small enough to stay in the cache.
const BUFFER: usize = 1 << 18;

/// Writes `path` by way of `fill`; returns the file's size in bytes.
///
/// A file that was there before is replaced in one step. If anything fails the temporary file is removed and the
/// old one, if any, is untouched. `fill` gets a buffered writer and need not flush it.
///
/// # Errors
/// [`IoError::Write`] names the file, the cause and what to do.
pub fn write(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<u64, IoError> {
    write_file(path, |file| fill(file))
}

/// As [`write`], for those that must go back in the file.
pub(crate) fn write_file(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<u64, IoError> {
    let temporary = Temporary::beside(path);
    let attempt = || -> io::Result<u64> {
        let mut buffer = BufWriter::with_capacity(BUFFER, temporary.create()?);
        fill(&mut buffer)?;
        // Unwrapping the buffer by hand reports the error that dropping it would swallow.
        let file = buffer.into_inner().map_err(io::IntoInnerError::into_error)?;
        let bytes = file.metadata()?.len();
        temporary.rename_to(path)?;
        Ok(bytes)
    };
    attempt().map_err(|error| IoError::write(path, &error))
}

/// Makes `folder` with all its parents if need be, and finds out now whether files can be written there.
///
/// A run that would fail at its first frame fails before its first step instead.
///
/// # Errors
/// [`IoError::Write`] names the folder, the cause and what to do.
pub fn prepare_folder(folder: &Path) -> Result<(), IoError> {
    let attempt = || -> io::Result<()> {
        fs::create_dir_all(folder)?;
        let probe = Temporary::beside(&folder.join("probe"));
        let mut file = probe.create()?;
        // An empty file can often be made on a full disk; only data shows that there is room.
        file.write_all(&[0; 4096])?;
        file.sync_all()
    };
    attempt().map_err(|error| IoError::write(folder, &error))
}

/// A temporary name beside a file; the file of that name is removed when this is dropped, unless it was renamed.
#[derive(Debug)]
pub(crate) struct Temporary(PathBuf);

impl Temporary {
    /// A hidden name that no other process and no other call in this one uses.
    pub(crate) fn beside(path: &Path) -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        Self(path.with_file_name(format!(".{name}.{}-{number}.partial", std::process::id())))
    }

    pub(crate) fn path(&self) -> &Path {
        &self.0
    }

    /// Makes the file, to be written and read again.
    pub(crate) fn create(&self) -> io::Result<File> {
        File::options().read(true).write(true).create_new(true).open(&self.0)
    }

    pub(crate) fn rename_to(&self, path: &Path) -> io::Result<()> {
        fs::rename(&self.0, path)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        // After a rename there is nothing to remove, and a second failure would only hide the first.
        let _ = fs::remove_file(&self.0);
    }
}
