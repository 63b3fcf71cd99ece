//! Files that are complete or absent: a file is written under a temporary name in the same folder and then renamed.
//!
//! A program that watches the folder (ParaView reloading a series, a script) never reads an incomplete frame, and a run
//! that is killed or fills the disk leaves all earlier frames intact. A power failure can still destroy files, because
//! the data is not flushed to the disk: each frame would have to wait for it.
//!
//! *Why not the `tempfile` crate:* it creates files that only their owner can read; an output file has the user's
//! default permissions.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use crate::error::IoError;

/// Bytes of the write buffer. It needs few system calls per frame and fits into the cache.
const BUFFER: usize = 1 << 18;

/// Writes `path` with `fill`; returns the file's size in bytes.
///
/// An existing file is replaced in one step. On failure the temporary file is removed and an existing file is unchanged.
/// `fill` gets a buffered writer and need not flush it.
///
/// # Errors
/// [`IoError::Write`] names the file, the cause and what to do.
pub fn write(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<u64, IoError> {
    write_file(path, |file| fill(file))
}

/// Like [`write`], for formats that seek in the file.
pub(crate) fn write_file(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<u64, IoError> {
    let temporary = Temporary::beside(path);
    let attempt = || -> io::Result<u64> {
        let mut buffer = BufWriter::with_capacity(BUFFER, temporary.create()?);
        fill(&mut buffer)?;
        // `into_inner` reports an error of the last write; dropping the buffer would ignore it.
        let file = buffer.into_inner().map_err(io::IntoInnerError::into_error)?;
        let bytes = file.metadata()?.len();
        temporary.rename_to(path)?;
        Ok(bytes)
    };
    attempt().map_err(|error| IoError::write(path, &error))
}

/// Creates `folder` with its parents if necessary, and checks that files can be written there.
///
/// A run calls it before its first step, so that it does not fail at its first frame.
///
/// # Errors
/// [`IoError::Write`] names the folder, the cause and what to do.
pub fn prepare_folder(folder: &Path) -> Result<(), IoError> {
    let attempt = || -> io::Result<()> {
        fs::create_dir_all(folder)?;
        let probe = Temporary::beside(&folder.join("probe"));
        let mut file = probe.create()?;
        // An empty file can often be created on a full disk, so data is written to check that there is space.
        file.write_all(&[0; 4096])?;
        file.sync_all()
    };
    attempt().map_err(|error| IoError::write(folder, &error))
}

/// A temporary name in the folder of a file. The file with that name is removed on drop unless it was renamed.
#[derive(Debug)]
pub(crate) struct Temporary(PathBuf);

impl Temporary {
    /// A hidden name that no other process and no other call in this process uses.
    pub(crate) fn beside(path: &Path) -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        Self(path.with_file_name(format!(".{name}.{}-{number}.partial", std::process::id())))
    }

    pub(crate) fn path(&self) -> &Path {
        &self.0
    }

    /// Creates the file for writing and reading.
    pub(crate) fn create(&self) -> io::Result<File> {
        File::options().read(true).write(true).create_new(true).open(&self.0)
    }

    pub(crate) fn rename_to(&self, path: &Path) -> io::Result<()> {
        fs::rename(&self.0, path)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        // After a rename there is no file to remove. A failure here would only hide an earlier one.
        let _ = fs::remove_file(&self.0);
    }
}
