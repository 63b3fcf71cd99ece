//! The lock of an output folder: at most one run at a time writes into it.

use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};

use crate::RunError;

/// Excludes other runs from an output folder until it is dropped. The operating system releases the lock when the
/// process ends for any reason.
///
/// On Unix the folder itself is locked. Where that is not possible (Windows, NFS), the lock is that of an empty file,
/// which remains if the process is killed and then does not lock the folder.
#[derive(Debug)]
pub(crate) struct FolderLock {
    /// The lock file, if there is one.
    path: Option<PathBuf>,
    /// Holds the lock.
    _file: File,
}

impl FolderLock {
    /// Locks an existing folder. On a file system without locks no run is excluded.
    ///
    /// # Errors
    /// [`RunError::FolderInUse`] while another run writes into it; [`RunError::Lock`] if the lock file cannot be
    /// created.
    pub fn take(folder: &Path) -> Result<Self, RunError> {
        if cfg!(unix)
            && let Ok(file) = File::open(folder)
        {
            match file.try_lock() {
                Ok(()) => return Ok(Self { path: None, _file: file }),
                Err(TryLockError::WouldBlock) => {
                    return Err(RunError::FolderInUse { folder: folder.to_owned() });
                }
                Err(TryLockError::Error(_)) => {}
            }
        }
        Self::take_file(folder)
    }

    /// Locks by a file.
    fn take_file(folder: &Path) -> Result<Self, RunError> {
        let path = folder.join(".lock");
        loop {
            let file = File::options()
                .create(true)
                .truncate(false)
                .write(true)
                .open(&path)
                .map_err(|error| RunError::Lock { path: path.clone(), detail: error.to_string() })?;
            match file.try_lock() {
                Err(TryLockError::WouldBlock) => {
                    return Err(RunError::FolderInUse { folder: folder.to_owned() });
                }
                Ok(()) if !is_at(&file, &path) => {}
                Ok(()) | Err(TryLockError::Error(_)) => return Ok(Self { path: Some(path), _file: file }),
            }
        }
    }
}

/// Whether the open file is still the one at this path. A run that ends between opening and locking removes the file;
/// the next run would then create and lock a new file of the same name.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    match (file.metadata(), fs::metadata(path)) {
        (Ok(file), Ok(at)) => (file.dev(), file.ino()) == (at.dev(), at.ino()),
        _ => false,
    }
}

/// Always true: on other systems an open file cannot be removed.
#[cfg(not(unix))]
fn is_at(_: &File, _: &Path) -> bool {
    true
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        if let Some(path) = &self.path {
            // A file that cannot be removed does not lock the folder.
            let _ = fs::remove_file(path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::FolderLock;
    use crate::RunError;

    #[test]
    fn a_folder_is_locked_once_and_released() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        for take in [FolderLock::take, FolderLock::take_file] {
            let first = take(folder.path())?;
            let refused = take(folder.path());
            assert!(matches!(refused, Err(RunError::FolderInUse { .. })));
            drop(first);
            assert_eq!(std::fs::read_dir(folder.path())?.count(), 0);
            // The file of a killed process does not lock.
            std::fs::write(folder.path().join(".lock"), "")?;
            assert!(take(folder.path()).is_ok());
            let _ = std::fs::remove_file(folder.path().join(".lock"));
        }
        Ok(())
    }

    #[cfg(unix)]
    #[test]
    fn a_removed_lock_file_is_detected() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join(".lock");
        let file = std::fs::File::create(&path)?;
        assert!(super::is_at(&file, &path));
        std::fs::remove_file(&path)?;
        assert!(!super::is_at(&file, &path));
        let other = std::fs::File::create(&path)?;
        assert!(!super::is_at(&file, &path) && super::is_at(&other, &path));
        Ok(())
    }
}
