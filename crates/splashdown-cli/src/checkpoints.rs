//! The checkpoints of a run: when they are taken, when they are written, and where one is found again.

use std::collections::VecDeque;
use std::fs;
use std::path::{Path, PathBuf};

use splashdown::{Checkpoint, Run};
use splashdown_io::{FrameWriter, Job};

use crate::exit::{Exit, Failure};
use crate::layout::Layout;
use crate::wishes::Wishes;

/// How many stay on the disk: one more than needed, should the newest be damaged from outside.
const KEPT: usize = 2;

/// Takes checkpoints and writes each once the files of all frames up to it are complete: whoever goes on from it has them.
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
            writer.submit(vec![Job::Bytes(self.layout.checkpoint(frame), checkpoint.to_bytes()?)])?;
            self.layout.keep_checkpoints(KEPT);
        }
        Ok(())
    }

    /// Writes the rest, once the writer has ended. The last one's path comes back, if there is one on the disk.
    ///
    /// # Errors
    /// [`Exit::Files`].
    pub fn finish(mut self, complete: Option<u32>) -> Result<Option<PathBuf>, Failure> {
        while let Some((frame, checkpoint)) = self.taken.pop_front() {
            if complete.is_some_and(|complete| frame <= complete) {
                self.layout.make_checkpoints()?;
                checkpoint.write(&self.layout.checkpoint(frame))?;
            }
        }
        self.layout.keep_checkpoints(KEPT);
        Ok(self.layout.checkpoints().pop())
    }
}

/// A checkpoint to go on from.
#[derive(Debug)]
pub struct Found {
    /// It.
    pub checkpoint: Checkpoint,
    /// The output folder of the run that wrote it, if it lies in one.
    pub root: Option<PathBuf>,
    /// Newer ones that cannot be used, and why.
    pub passed_over: Vec<String>,
}

/// Finds what `path` names: a checkpoint, or the newest one below an output folder.
///
/// # Errors
/// [`Exit::Files`], with what is there instead.
pub fn find(path: &Path) -> Result<Found, Failure> {
    let refuse = |message: String| Failure::new(Exit::Files, message);
    if path.is_file() {
        let checkpoint = Checkpoint::read(path)?;
        return Ok(Found { checkpoint, root: root_of(path), passed_over: Vec::new() });
    }
    if !path.is_dir() {
        let message = format!(
            "--resume: there is no `{}`; name the output folder of a run, or a file that ends in .{}",
            path.display(),
            Checkpoint::ENDING
        );
        return Err(refuse(message));
    }
    let layout = Layout::new(path.to_owned(), 0);
    let mut passed_over = Vec::new();
    for file in layout.checkpoints().into_iter().rev() {
        match Checkpoint::read(&file) {
            Ok(checkpoint) => return Ok(Found { checkpoint, root: Some(path.to_owned()), passed_over }),
            Err(error) => passed_over.push(error.to_string()),
        }
    }
    let reason = match passed_over.as_slice() {
        [] => "it holds none; `--checkpoint-every N` writes them, and so does Ctrl-C".to_owned(),
        reasons => reasons.join("; "),
    };
    Err(refuse(format!("--resume: no checkpoint in `{}` can be used: {reason}", path.display())))
}

/// The output folder that a checkpoint lies in, if it lies in one.
fn root_of(checkpoint: &Path) -> Option<PathBuf> {
    let folder = checkpoint.parent()?;
    if folder.ends_with(Layout::CHECKPOINTS) {
        let root = folder.parent()?;
        return Some(if root.as_os_str().is_empty() { PathBuf::from(".") } else { root.to_owned() });
    }
    // As seen from inside the folder of the checkpoints.
    let whole = checkpoint.canonicalize().ok()?;
    let folder = whole.parent().filter(|folder| folder.ends_with(Layout::CHECKPOINTS))?;
    folder.parent().map(Path::to_owned)
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
