//! One run at a time writes into a folder.

use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};

use crate::exit::{Exit, Failure};

/// Keeps other runs out of an output folder while it lives. The system lets go of it with the process, however that
/// ends; what is left then is an empty file that holds nobody up.
#[derive(Debug)]
pub struct FolderLock {
    path: PathBuf,
    /// Holds the lock.
    _file: File,
}

impl FolderLock {
    /// Takes the folder, which is there. Where the file system knows no locks nobody is kept out.
    ///
    /// # Errors
    /// [`Exit::Usage`] while another run writes there; [`Exit::Files`] if nothing can be written.
    pub fn take(folder: &Path) -> Result<Self, Failure> {
        let path = folder.join(".lock");
        loop {
            let file =
                File::options().create(true).truncate(false).write(true).open(&path).map_err(|error| {
                    Failure::new(Exit::Files, format!("cannot write `{}`: {error}", path.display()))
                })?;
            match file.try_lock() {
                Err(TryLockError::WouldBlock) => {
                    let message = format!(
                        "another run is writing into `{}`: wait until it is done or stop it, or choose another --out",
                        folder.display()
                    );
                    return Err(Failure::new(Exit::Usage, message));
                }
                Ok(()) if !is_at(&file, &path) => {}
                Ok(()) | Err(TryLockError::Error(_)) => return Ok(Self { path, _file: file }),
            }
        }
    }
}

/// False if a run that ended between the opening and the locking of the file has taken it away: whoever comes next would
/// lock another of that name.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    match (file.metadata(), fs::metadata(path)) {
        (Ok(file), Ok(at)) => (file.dev(), file.ino()) == (at.dev(), at.ino()),
        _ => false,
    }
}

/// Elsewhere an open file cannot be taken away.
#[cfg(not(unix))]
fn is_at(_: &File, _: &Path) -> bool {
    true
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        // One that stays is in nobody's way.
        let _ = fs::remove_file(&self.path);
    }
}

#[cfg(test)]
mod tests {
    use super::FolderLock;
    use crate::exit::Exit;

    #[test]
    fn a_folder_is_taken_once_and_let_go() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let first = FolderLock::take(folder.path()).map_err(|failure| failure.message)?;
        let refused = FolderLock::take(folder.path()).err().map(|failure| failure.exit);
        assert_eq!(refused, Some(Exit::Usage));
        drop(first);
        assert_eq!(std::fs::read_dir(folder.path())?.count(), 0);
        // What a killed process left is no obstacle.
        std::fs::write(folder.path().join(".lock"), "")?;
        assert!(FolderLock::take(folder.path()).is_ok());
        Ok(())
    }

    #[cfg(unix)]
    #[test]
    fn a_file_that_was_taken_away_is_no_lock() -> Result<(), Box<dyn std::error::Error>> {
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
