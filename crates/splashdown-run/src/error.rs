//! The errors of this crate.

use std::path::PathBuf;

use splashdown::error::CheckpointError;
use splashdown::{Checkpoint, SimulationError};
use splashdown_gpu::GpuError;
use splashdown_io::IoError;
use splashdown_render::RenderError;

/// An error of a run or its files.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// The simulation failed.
    #[error(transparent)]
    Simulation(#[from] SimulationError),

    /// A checkpoint is unreadable or does not fit.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),

    /// The device is missing or was lost.
    #[error(transparent)]
    Gpu(#[from] GpuError),

    /// A file or folder could not be written or read.
    #[error(transparent)]
    Io(#[from] IoError),

    /// The device cannot draw the pictures.
    #[error("the pictures cannot be drawn: {0}")]
    Render(#[from] RenderError),

    /// Pictures of the surface were requested without a surface.
    #[error(
        "pictures of the surface need a surface: enable it (surface.enabled = true in the scene), or draw pictures of the \
         particles only"
    )]
    SurfaceRequired,

    /// Another run holds the lock of the output folder.
    #[error("another run is writing into `{}`: wait until it ends, stop it, or choose another output folder", folder.display())]
    FolderInUse {
        /// The output folder.
        folder: PathBuf,
    },

    /// The lock of the output folder could not be created.
    #[error("cannot write `{}`: {detail}", path.display())]
    Lock {
        /// The lock file.
        path: PathBuf,
        /// The message of the operating system.
        detail: String,
    },

    /// The run to resume has no frames left.
    #[error(
        "frame {done} is already complete and the run ends with frame {frames}: request more frames to extend it"
    )]
    AlreadyFinished {
        /// The frame of the checkpoint.
        done: u32,
        /// The number of frames requested.
        frames: u32,
    },

    /// Neither a file nor a folder exists at the path to resume from.
    #[error("there is no `{}`; name the output folder of a run, or a file that ends in .{}", path.display(), Checkpoint::ENDING)]
    NothingToResume {
        /// The path given.
        path: PathBuf,
    },

    /// The path to resume from is a pipe or a device.
    #[error("`{}` is a pipe or a device; name the output folder of a run, or a file that ends in .{}", path.display(), Checkpoint::ENDING)]
    NotAFile {
        /// The path given.
        path: PathBuf,
    },

    /// The folder to resume from contains no checkpoints.
    #[error("no checkpoint in `{}` can be used: the folder contains none", path.display())]
    NoCheckpoint {
        /// The folder given.
        path: PathBuf,
    },

    /// The folder to resume from contains checkpoints, but no usable one.
    #[error("no checkpoint in `{}` can be used: {reason}", path.display())]
    NoUsableCheckpoint {
        /// The folder given.
        path: PathBuf,
        /// What is wrong with each of them.
        reason: String,
    },

    /// The scene of a run is not known.
    #[error("{0}; give the scene of the run")]
    UnknownScene(String),

    /// No file, or files of several series, match the input given.
    #[error("{0}")]
    Input(String),

    /// The output name does not fit the input files.
    #[error("{0}")]
    Output(String),
}
