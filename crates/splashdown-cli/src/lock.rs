//! One run at a time writes into a folder.

use std::fs::{File, TryLockError};
use std::path::Path;

use crate::exit::{Exit, Failure};

/// Keeps other runs out of an output folder while it lives. The system lets go of it with the process, however
/// that ends. The empty file stays: between taking it away and letting go of it, two others could each hold one
/// of that name.
#[derive(Debug)]
pub struct FolderLock {
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
        let file = File::options().create(true).truncate(false).write(true).open(&path).map_err(|error| {
            Failure::new(Exit::Files, format!("cannot write `{}`: {error}", path.display()))
        })?;
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => {
                let message = format!(
                    "another run is writing into `{}`: wait until it is done or stop it, or choose another --out",
                    folder.display()
                );
                Err(Failure::new(Exit::Usage, message))
            }
            Ok(()) | Err(TryLockError::Error(_)) => Ok(Self { _file: file }),
        }
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
        // What it left is no obstacle.
        assert!(folder.path().join(".lock").exists());
        assert!(FolderLock::take(folder.path()).is_ok());
        Ok(())
    }
}
