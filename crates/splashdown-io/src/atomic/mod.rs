//! Files that are complete or absent: a file gets its name when it is complete. Until then it has none (Linux) or a temporary
//! one in the same folder.
//!
//! A program that watches the folder (ParaView reloading a series, a script) never reads an incomplete frame, and a run
//! that is killed or fills the disk leaves all earlier frames intact. The data and the folder are flushed to the disk
//! before a file is announced, so that announced files survive a power failure ([`set_sync`]).
//!
//! On Linux the temporary file has no name until it is complete (`temporary`), so a killed process leaves none behind.
//!
//! *Why not the `tempfile` crate:* it creates files that only their owner can read; an output file has the user's
//! default permissions.

mod temporary;

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

pub(crate) use self::temporary::Temporary;
use crate::error::IoError;

/// Bytes of the write buffer. It needs few system calls per frame and fits into the cache.
const BUFFER: usize = 1 << 18;

/// Whether files are flushed to the disk.
static SYNC: AtomicBool = AtomicBool::new(true);

/// Selects whether this process flushes each file and its folder to the disk before it announces the file; it does by
/// default. Without, a power failure can destroy the newest files; a killed process loses nothing in either case.
///
/// This applies to the whole process, because it depends on the disk and not on the file.
pub fn set_sync(sync: bool) {
    SYNC.store(sync, Ordering::Relaxed);
}

/// Flushes the data of a file to the disk, unless [`set_sync`] has turned this off.
pub(crate) fn sync_file(file: &File) -> io::Result<()> {
    if SYNC.load(Ordering::Relaxed) { file.sync_data() } else { Ok(()) }
}

/// Flushes the entry of a file in its folder to the disk, like [`sync_file`]. Only Unix can flush a folder.
pub(crate) fn sync_parent(path: &Path) -> io::Result<()> {
    if !cfg!(unix) || !SYNC.load(Ordering::Relaxed) {
        return Ok(());
    }
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    match File::open(parent).and_then(|folder| folder.sync_all()) {
        // A folder that may be written but not read, and file systems that cannot flush folders.
        Err(error)
            if matches!(error.kind(), io::ErrorKind::PermissionDenied | io::ErrorKind::InvalidInput) =>
        {
            Ok(())
        }
        result => result,
    }
}

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
    let attempt = || -> io::Result<u64> {
        let temporary = Temporary::create(path)?;
        let mut buffer = BufWriter::with_capacity(BUFFER, temporary.file().try_clone()?);
        fill(&mut buffer)?;
        // `into_inner` reports an error of the last write; dropping the buffer would ignore it.
        let file = buffer.into_inner().map_err(io::IntoInnerError::into_error)?;
        let bytes = file.metadata()?.len();
        temporary.persist(path)?;
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
        let probe = Temporary::create(&folder.join("probe"))?;
        // An empty file can often be created on a full disk, so data is written to check that there is space.
        let mut file = probe.file();
        file.write_all(&[0; 4096])?;
        file.sync_all()
    };
    attempt().map_err(|error| IoError::write(folder, &error))
}
