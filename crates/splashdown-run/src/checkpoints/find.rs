//! Finding a checkpoint to resume from.

use std::fs;
use std::path::{Path, PathBuf};

use splashdown::Checkpoint;
use splashdown::error::CheckpointError;

use crate::settings::Notes;
use crate::{RunError, RunFolder};

/// A checkpoint to resume from.
#[derive(Debug)]
#[non_exhaustive]
pub struct FoundCheckpoint {
    /// The checkpoint.
    pub checkpoint: Checkpoint,
    /// The settings and the state of the files of the run that wrote it.
    pub(crate) notes: Notes,
    /// The output folder that contains it, if it is in one.
    pub root: Option<PathBuf>,
    /// Newer checkpoints that cannot be used, and why.
    pub skipped: Vec<String>,
}

/// Finds the checkpoint that `path` names: a file, an output folder, or its folder of checkpoints. In a folder the
/// newest usable checkpoint is found.
///
/// # Errors
/// [`RunError::NothingToResume`], [`RunError::NoCheckpoint`], [`RunError::NoUsableCheckpoint`]; for a file also
/// [`RunError::Checkpoint`].
pub fn find_checkpoint(path: &Path) -> Result<FoundCheckpoint, RunError> {
    if path.is_file() {
        let (checkpoint, notes) = read(path)?;
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        let root = RunFolder::root_of_checkpoints(folder.unwrap_or(Path::new(".")));
        return Ok(FoundCheckpoint { checkpoint, notes, root, skipped: Vec::new() });
    }
    if path.exists() && !path.is_dir() {
        return Err(RunError::NotAFile { path: path.to_owned() });
    }
    if !path.is_dir() {
        return Err(RunError::NothingToResume { path: path.to_owned() });
    }
    let mut root = path.to_owned();
    let mut files = RunFolder::new(root.clone(), 0).checkpoints();
    if let (true, Some(above)) = (files.is_empty(), RunFolder::root_of_checkpoints(path)) {
        files = RunFolder::new(above.clone(), 0).checkpoints();
        root = above;
    }
    let mut skipped = Vec::new();
    for file in files.into_iter().rev() {
        match read(&file) {
            Ok((checkpoint, notes)) => {
                return Ok(FoundCheckpoint { checkpoint, notes, root: Some(root), skipped });
            }
            Err(error) => skipped.push(error.to_string()),
        }
    }
    let path = path.to_owned();
    Err(match (skipped.as_slice(), in_folder(&path).min()) {
        ([], None) => RunError::NoCheckpoint { path },
        ([], Some(file)) => {
            let reason = format!("it is not the folder of a run; name a file, as in `{}`", file.display());
            RunError::NoUsableCheckpoint { path, reason }
        }
        (reasons, _) => RunError::NoUsableCheckpoint { path, reason: reasons.join("; ") },
    })
}

/// The newest checkpoints in the current folder and in the runs below `out`, at most `count`.
pub fn recent_checkpoints(count: usize) -> Vec<PathBuf> {
    let runs = fs::read_dir("out").into_iter().flatten().flatten().map(|entry| entry.path());
    let checkpoints = runs.map(|root| RunFolder::new(root, 0).checkpoint_folder());
    let folders = std::iter::once(PathBuf::from(".")).chain(checkpoints);
    let mut files: Vec<PathBuf> = folders.flat_map(|folder| in_folder(&folder)).collect();
    files.sort_by_key(|path| std::cmp::Reverse(path.metadata().and_then(|data| data.modified()).ok()));
    files.truncate(count);
    files
}

fn read(path: &Path) -> Result<(Checkpoint, Notes), CheckpointError> {
    let checkpoint = Checkpoint::read(path)?;
    let notes = Notes::in_checkpoint(&checkpoint).map_err(|error| match error {
        CheckpointError::Malformed(reason) => {
            CheckpointError::Malformed(format!("`{}`: {reason}", path.display()))
        }
        other => other,
    })?;
    Ok((checkpoint, notes))
}

/// All checkpoints in a folder, also those that no run has named.
fn in_folder(folder: &Path) -> impl Iterator<Item = PathBuf> + use<> {
    let files = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    files
        .filter(|path| path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(Checkpoint::ENDING)))
}
