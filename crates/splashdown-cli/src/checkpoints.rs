//! The checkpoints of a run: when they are taken, when they are written, and where one is found again.

use std::collections::VecDeque;
use std::fs;
use std::path::{Path, PathBuf};

use splashdown::{Checkpoint, CheckpointError, Run};
use splashdown_io::{FrameWriter, Job, WrittenFile};

use crate::exit::{Exit, Failure};
use crate::layout::Layout;
use crate::wishes::Wishes;

/// How many stay on the disk: one more than needed, should the newest be damaged from outside.
const KEPT: usize = 2;

/// Takes checkpoints and writes each once the files of all frames up to it are complete: whoever goes on from
/// it has them.
#[derive(Debug)]
pub struct Checkpoints {
    layout: Layout,
    wishes: Wishes,
    taken: VecDeque<(u32, Checkpoint)>,
    last: Option<u32>,
}

impl Checkpoints {
    /// None yet.
    pub fn new(layout: Layout, wishes: Wishes) -> Self {
        Self { layout, wishes, taken: VecDeque::new(), last: None }
    }

    /// True if one is due after this frame.
    pub fn due(&self, frame: u32) -> bool {
        self.wishes.checkpoint_every.is_some_and(|every| frame.is_multiple_of(every) && frame > 0)
    }

    /// Takes one after the run's last frame, unless it is there already.
    ///
    /// # Errors
    /// As [`Run::checkpoint`].
    pub fn take(&mut self, run: &mut Run, frame: u32, probe_bytes: Vec<u64>) -> Result<(), Failure> {
        if self.last == Some(frame) {
            return Ok(());
        }
        let mut checkpoint = run.checkpoint()?;
        let notes = Wishes { probe_bytes, ..self.wishes.clone() };
        checkpoint.set_notes(&serde_json::to_string_pretty(&notes).unwrap_or_default());
        self.taken.push_back((frame, checkpoint));
        self.last = Some(frame);
        Ok(())
    }

    /// Hands over those whose frames are complete.
    ///
    /// # Errors
    /// The writer's first failure.
    pub fn write(&mut self, complete: u32, writer: &FrameWriter) -> Result<(), Failure> {
        while let Some((frame, checkpoint)) = self.taken.pop_front_if(|(frame, _)| *frame <= complete) {
            // Before, so that there are never more than are promised. The one that stays is whole, whatever
            // becomes of this one.
            self.layout.keep_checkpoints(KEPT - 1);
            writer.submit(vec![Job::Bytes(self.layout.checkpoint(frame), checkpoint.to_bytes()?)])?;
        }
        Ok(())
    }

    /// Writes the rest, once the writer has ended, and returns it.
    ///
    /// # Errors
    /// [`Exit::Files`].
    pub fn finish(mut self, complete: Option<u32>) -> Result<Vec<WrittenFile>, Failure> {
        let mut written = Vec::new();
        while let Some((frame, checkpoint)) = self.taken.pop_front() {
            if complete.is_some_and(|complete| frame <= complete) {
                self.layout.make_checkpoints()?;
                self.layout.keep_checkpoints(KEPT - 1);
                let path = self.layout.checkpoint(frame);
                let bytes = checkpoint.write(&path)?;
                written.push(WrittenFile { path, bytes });
            }
        }
        self.layout.keep_checkpoints(KEPT);
        Ok(written)
    }
}

/// A checkpoint to go on from.
#[derive(Debug)]
pub struct Found {
    /// It.
    pub checkpoint: Checkpoint,
    /// What was asked of the run that wrote it.
    pub wishes: Wishes,
    /// The output folder of the run that wrote it, if it lies in one.
    pub root: Option<PathBuf>,
    /// Newer ones that cannot be used, and why.
    pub passed_over: Vec<String>,
}

/// Finds what `path` names: a checkpoint, or the newest one below an output folder or in its folder of checkpoints.
///
/// # Errors
/// [`Exit::Files`], with what is there instead.
pub fn find(path: &Path) -> Result<Found, Failure> {
    let refuse = |message: String| Failure::new(Exit::Files, message);
    if path.is_file() {
        let (checkpoint, wishes) = read(path)?;
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        let root = root_of(folder.unwrap_or(Path::new(".")));
        return Ok(Found { checkpoint, wishes, root, passed_over: Vec::new() });
    }
    if !path.is_dir() {
        let message = format!(
            "there is no `{}`; name the output folder of a run, or a file that ends in .{}",
            path.display(),
            Checkpoint::ENDING
        );
        return Err(refuse(message));
    }
    let mut root = path.to_owned();
    let mut files = Layout::new(root.clone(), 0).checkpoints();
    if let (true, Some(above)) = (files.is_empty(), root_of(path)) {
        files = Layout::new(above.clone(), 0).checkpoints();
        root = above;
    }
    let mut passed_over = Vec::new();
    for file in files.into_iter().rev() {
        match read(&file) {
            Ok((checkpoint, wishes)) => {
                return Ok(Found { checkpoint, wishes, root: Some(root), passed_over });
            }
            Err(error) => passed_over.push(error.to_string()),
        }
    }
    let reason = match (passed_over.as_slice(), any_in(path)) {
        ([], None) => "it holds none; `--checkpoint-every N` writes them, and so does Ctrl-C".to_owned(),
        ([], Some(file)) => format!("no run wrote it; name a file, as in `{}`", file.display()),
        (reasons, _) => reasons.join("; "),
    };
    Err(refuse(format!("no checkpoint in `{}` can be used: {reason}", path.display())))
}

fn read(path: &Path) -> Result<(Checkpoint, Wishes), CheckpointError> {
    let checkpoint = Checkpoint::read(path)?;
    let wishes = Wishes::in_checkpoint(&checkpoint).map_err(|error| match error {
        CheckpointError::Malformed(reason) => {
            CheckpointError::Malformed(format!("`{}`: {reason}", path.display()))
        }
        other => other,
    })?;
    Ok((checkpoint, wishes))
}

/// A checkpoint of whatever name in a folder.
fn any_in(folder: &Path) -> Option<PathBuf> {
    let files = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    files.filter(|path| path.extension().is_some_and(|ending| ending == Checkpoint::ENDING)).min()
}

/// The output folder to which a folder of checkpoints belongs, if it is one.
fn root_of(folder: &Path) -> Option<PathBuf> {
    if folder.ends_with(Layout::CHECKPOINTS) {
        let root = folder.parent()?;
        return Some(if root.as_os_str().is_empty() { PathBuf::from(".") } else { root.to_owned() });
    }
    // As seen from inside of it.
    let whole = folder.canonicalize().ok().filter(|folder| folder.ends_with(Layout::CHECKPOINTS))?;
    whole.parent().map(Path::to_owned)
}

/// Removes what a run that was killed left half-written below its folder.
pub fn remove_partial(root: &Path) {
    let folders = fs::read_dir(root).into_iter().flatten().flatten().map(|entry| entry.path());
    for folder in folders.filter(|path| path.is_dir()).chain([root.to_owned()]) {
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            let name = entry.file_name();
            let name = name.to_string_lossy();
            if name.starts_with('.') && name.ends_with(".partial") {
                // It is in nobody's way if it stays.
                let _ = fs::remove_file(entry.path());
            }
        }
    }
}
