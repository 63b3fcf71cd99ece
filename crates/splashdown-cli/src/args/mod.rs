//! The command line: one declaration defines the parser, the help and the shell completions.

mod bench;
mod plot;
mod render;
mod run;
mod scenes;
mod surface;
mod view;

use std::ffi::OsString;
use std::ops::RangeInclusive;
use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{ArgAction, Args, CommandFactory, FromArgMatches, Parser, Subcommand};
use clap_complete::Shell;
use splashdown::Device;
use splashdown::scene::Choice;
use splashdown::surface::MAX_BLOB;
use splashdown_io::Format;

use crate::console::Verbosity;
use crate::exit;

pub use bench::BenchArguments;
pub use plot::PlotArguments;
pub use render::{FrameRange, RenderArguments};
pub use run::RunArguments;
pub use scenes::{ScenesAction, ScenesArguments};
pub use surface::SurfaceArguments;
pub use view::ViewArguments;

/// Fast SPH water on any GPU, from a scene file to particles, a watertight mesh and a picture.
#[derive(Debug, Parser)]
#[command(name = "splashdown", version, max_term_width = 100, after_help = exit::HELP)]
pub struct Arguments {
    /// The command.
    #[command(subcommand)]
    pub command: Command,
    /// Largest size in GiB of the data of one input file after decompression
    /// [default: 64 times the size of the file, and at least 0.25]
    #[arg(long, global = true, value_name = "GIB", value_parser = gibibytes)]
    pub input_limit: Option<u64>,
}

impl Arguments {
    /// Reads a command line.
    ///
    /// # Errors
    /// An invalid command line, and requests for help or the version.
    pub fn read(
        arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>,
    ) -> Result<Self, clap::Error> {
        // A negative number is a value out of range and not an unknown option.
        let command = Self::command().mut_subcommands(|command| command.allow_negative_numbers(true));
        Self::from_arg_matches_mut(&mut command.try_get_matches_from(arguments)?)
    }
}

/// A whole number in a range.
fn whole(range: RangeInclusive<u32>) -> impl Fn(&str) -> Result<u32, String> + Clone {
    move |text| {
        let number = text.parse().ok().filter(|number| range.contains(number));
        number.ok_or_else(|| format!("it is a whole number from {} to {}", range.start(), range.end()))
    }
}

/// A limit of particles or neighbours below which particles become droplets.
fn limit() -> impl Fn(&str) -> Result<u32, String> + Clone {
    whole(0..=MAX_BLOB)
}

/// A size in GiB, as bytes.
fn gibibytes(text: &str) -> Result<u64, String> {
    match text.parse::<f64>() {
        Ok(size) if size > 0.0 && size <= 65_536.0 => Ok((size * f64::from(1 << 30)) as u64),
        _ => Err("a limit is a number of GiB above 0 and at most 65536, such as 8".to_owned()),
    }
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Simulate a scene and write its frames
    Run(RunArguments),
    /// Open an interactive window
    View(ViewArguments),
    /// Validate a scene and print derived quantities without simulating
    Check(CheckArguments),
    /// List this machine's devices, their limits, and missing software
    Doctor(DoctorArguments),
    /// List, show or copy the built-in scenes
    Scenes(ScenesArguments),
    /// Reconstruct surface meshes from particle files
    Surface(SurfaceArguments),
    /// Draw the frames of a finished run again
    Render(RenderArguments),
    /// Plot the tables of probes
    Plot(PlotArguments),
    /// Measure the time per step, by pass and by number of particles
    Bench(BenchArguments),
    /// Print the completions of a shell
    Completions(CompletionsArguments),
}

/// Options for the amount of output.
#[derive(Debug, Args)]
pub struct VerbosityArguments {
    /// Print errors only
    #[arg(short, long, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Also print the log of the library
    #[arg(short, long, action = ArgAction::SetTrue)]
    pub verbose: bool,
}

impl VerbosityArguments {
    /// The verbosity that the options select.
    pub fn level(&self) -> Verbosity {
        match (self.quiet, self.verbose) {
            (true, _) => Verbosity::Quiet,
            (_, true) => Verbosity::Verbose,
            _ => Verbosity::Normal,
        }
    }
}

/// The device to compute on.
#[derive(Debug, Args)]
pub struct DeviceArgument {
    /// auto (the best GPU, else the CPU), gpu, cpu, or part of an adapter's name from `splashdown doctor`
    #[arg(short, long, value_name = "auto|gpu|cpu|NAME", default_value = "auto", value_parser = clap::value_parser!(Device))]
    pub device: Device,
}

const CHECK_EXAMPLES: &str = "\
Examples:
  splashdown check scenes/dam-break.toml
  splashdown check my.toml --json

The expected time is an estimate from a few measured steps of a small scene on this machine.";

/// Options of `check`.
#[derive(Debug, Args)]
#[command(after_help = CHECK_EXAMPLES)]
pub struct CheckArguments {
    /// Scene file (TOML), or the name of a built-in scene
    #[arg(value_name = "SCENE")]
    pub scene: PathBuf,
    #[command(flatten)]
    pub device: DeviceArgument,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
}

/// Options of `doctor`.
#[derive(Debug, Args)]
pub struct DoctorArguments {
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
}

const COMPLETIONS_EXAMPLES: &str = "\
Examples:
  splashdown completions bash > ~/.local/share/bash-completion/completions/splashdown
  splashdown completions zsh > ~/.zfunc/_splashdown
  splashdown completions fish > ~/.config/fish/completions/splashdown.fish
  splashdown completions powershell >> $PROFILE";

/// Options of `completions`.
#[derive(Debug, Args)]
#[command(after_help = COMPLETIONS_EXAMPLES)]
pub struct CompletionsArguments {
    /// The shell
    pub shell: Shell,
}

/// Parses one of the words that a scene file allows. Help and completions list the words.
fn choice<C: Choice + Send + Sync>() -> impl TypedValueParser<Value = C> {
    words::<C>(&[]).try_map(|word| C::from_name(&word).ok_or("unknown word"))
}

/// As [`choice`], with `none` as an additional word.
fn choice_or_none<C: Choice + Send + Sync>() -> impl TypedValueParser<Value = Option<C>> {
    words::<C>(&["none"]).map(|word| C::from_name(&word))
}

/// Whether the format stores the mesh of one frame.
pub fn is_mesh_file(format: &Format) -> bool {
    format.writes_meshes() && !format.is_series()
}

fn words<C: Choice>(more: &[&'static str]) -> PossibleValuesParser {
    let words = C::ALL.iter().map(|&(_, word, about)| PossibleValue::new(word).help(about.trim()));
    PossibleValuesParser::new(words.chain(more.iter().map(|word| PossibleValue::new(word).help("No files."))))
}
