//! Options of `scenes`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

const SCENES_EXAMPLES: &str = "\
Examples:
  splashdown scenes                       list them
  splashdown scenes show honey            print one
  splashdown scenes copy dam-break        write dam-break.toml here, to edit it
  splashdown scenes schema > scene.schema.json";

/// Options of `scenes`.
#[derive(Debug, Args)]
#[command(after_help = SCENES_EXAMPLES)]
pub struct ScenesArguments {
    /// The command; `list` if none is given.
    #[command(subcommand)]
    pub action: Option<ScenesAction>,
}

/// The commands of `scenes`.
#[derive(Debug, Subcommand)]
pub enum ScenesAction {
    /// List the scenes (the default)
    List,
    /// Print a scene file
    Show {
        /// Name of the scene
        name: String,
    },
    /// Copy a scene file, to edit it
    Copy {
        /// Name of the scene
        name: String,
        /// File or folder to write to
        #[arg(default_value = ".")]
        destination: PathBuf,
        /// Overwrite an existing file
        #[arg(short, long)]
        force: bool,
    },
    /// Print the JSON schema of scene files, for completion in an editor
    Schema,
    /// Print a table of all keys of a scene file, in Markdown
    Reference,
}
