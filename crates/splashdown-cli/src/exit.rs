//! Exit codes and error messages. `splashdown --help` lists the codes defined here.

use std::fmt;

use splashdown::SimulationError;
use splashdown::error::CheckpointError;
use splashdown::scene::SceneErrors;
use splashdown::surface::SurfaceError;
use splashdown_gpu::GpuError;
use splashdown_io::IoError;
use splashdown_run::RunError;
#[cfg(feature = "window")]
use splashdown_viewer::ViewerError;

/// The exit codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Exit {
    /// The command succeeded.
    Success = 0,
    /// The simulation failed.
    Failed = 1,
    /// The command line is invalid.
    Usage = 2,
    /// The scene file, or another input file, is missing or invalid.
    Scene = 3,
    /// The device is missing, too small, or was lost.
    Device = 4,
    /// A file or folder could not be written, or a checkpoint cannot be used.
    Files = 5,
    /// Stopped by Ctrl-C. Frames already written are complete.
    Interrupted = 130,
}

/// The list of exit codes in the help.
pub const HELP: &str = "\
Exit codes:
    0  success
    1  the simulation failed, or the fluid burst (frames already written are complete, and a
       checkpoint of the last sound state)
    2  the command line is invalid, or another run writes into the same folder
    3  the scene file, or another input file, is missing or invalid
    4  the device is missing, too small, or was lost; or pictures were requested and no
       device can draw them; or no window can be opened
    5  a file or folder could not be written (frames already written are complete), or a
       checkpoint cannot be used
  130  stopped by Ctrl-C (frames already written are complete)";

/// An error that ends the program.
#[derive(Debug)]
pub struct Failure {
    /// The exit code.
    pub exit: Exit,
    /// What is wrong and what to do.
    pub message: String,
    /// Every problem of a scene, for the JSON output.
    pub scene: Option<SceneErrors>,
}

impl Failure {
    /// A failure with this message.
    pub fn new(exit: Exit, message: impl Into<String>) -> Self {
        Self { exit, message: message.into(), scene: None }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl From<SceneErrors> for Failure {
    fn from(errors: SceneErrors) -> Self {
        Self { exit: Exit::Scene, message: errors.to_string(), scene: Some(errors) }
    }
}

impl From<CheckpointError> for Failure {
    fn from(error: CheckpointError) -> Self {
        Self::new(Exit::Files, error.to_string())
    }
}

impl From<SimulationError> for Failure {
    fn from(error: SimulationError) -> Self {
        let exit = match &error {
            SimulationError::Gpu(_)
            | SimulationError::Surface(SurfaceError::Gpu(_))
            | SimulationError::TooMany { .. } => Exit::Device,
            SimulationError::Checkpoint(_) => Exit::Files,
            SimulationError::Sample(_) | SimulationError::Body(_) => Exit::Scene,
            _ => Exit::Failed,
        };
        Self::new(exit, error.to_string())
    }
}

impl From<GpuError> for Failure {
    fn from(error: GpuError) -> Self {
        Self::new(Exit::Device, error.to_string())
    }
}

impl From<SurfaceError> for Failure {
    fn from(error: SurfaceError) -> Self {
        SimulationError::from(error).into()
    }
}

impl From<IoError> for Failure {
    fn from(error: IoError) -> Self {
        Self::new(Exit::Files, error.to_string())
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        let (exit, options) = match error {
            RunError::Simulation(error) => return error.into(),
            RunError::Gpu(_) | RunError::Render(_) => (Exit::Device, ""),
            RunError::SurfaceRequired => {
                (Exit::Usage, " (leave out --no-surface, or give --pictures particles)")
            }
            RunError::FolderInUse { .. } => (Exit::Usage, " (--out DIR)"),
            RunError::AlreadyFinished { .. } => (Exit::Usage, " (--frames N)"),
            RunError::Output(_) => (Exit::Usage, " (--out)"),
            RunError::Input(_) => (Exit::Scene, ""),
            RunError::UnknownScene(_) => (Exit::Usage, " (--scene FILE)"),
            RunError::NoCheckpoint { .. } => {
                (Exit::Files, "; `--checkpoint-every N` writes them, and so does Ctrl-C")
            }
            _ => (Exit::Files, ""),
        };
        Self::new(exit, format!("{error}{options}"))
    }
}

#[cfg(feature = "window")]
impl From<ViewerError> for Failure {
    fn from(error: ViewerError) -> Self {
        match error {
            ViewerError::Checkpoint(error) => error.into(),
            // No display, device or driver.
            error => Self::new(Exit::Device, error.to_string()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Exit, HELP};

    #[test]
    fn the_help_lists_every_code() {
        for exit in [
            Exit::Success,
            Exit::Failed,
            Exit::Usage,
            Exit::Scene,
            Exit::Device,
            Exit::Files,
            Exit::Interrupted,
        ] {
            let code = (exit as u8).to_string();
            assert!(HELP.lines().any(|line| line.split_whitespace().next() == Some(&code)), "{exit:?}");
        }
    }
}
