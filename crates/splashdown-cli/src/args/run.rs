//! Options of `run`.

use std::path::PathBuf;

use clap::Args;
use splashdown::Device;
use splashdown::scene::{Format, PictureKind};

use super::{VerbosityArguments, choice, choice_or_none};

const RUN_EXAMPLES: &str = "\
Examples:
  splashdown run scenes/dam-break.toml
  splashdown run dam-break --device cpu --frames 20 --no-pictures
  splashdown run my.toml --out out/test --formats vtu,obj --pictures surface
  splashdown run my.toml --checkpoint-every 10
  splashdown run --resume out/my
  splashdown run my.toml --json | jq 'select(.event == \"frame\") | .density_error'

What is written below the output folder:
  particles/particles_0000.ply, ...      one file per frame; particles.pvd is ParaView's index
                                         of .vtu files
  mesh/surface_0000.ply, ...             the closed surface of the fluid; its vertices have
                                         velocities in PLY, VTK and GLB
  particles.usda, surface.usda           all frames in one file, with --formats usd
  pictures/surface_0000.png, particles_0000.png
  surface.mp4, particles.mp4             if ffmpeg is installed
  checkpoints/checkpoint_0010.splashdown from which the run can go on: after Ctrl-C, and with
                                         --checkpoint-every; numpy.load opens them
  run.json                               the summary
Every file is complete or absent. Frames of an earlier run in the same folder are removed.
A run that goes on writes what was asked of it before, unless told otherwise.

With --json, stdout has one object per line. Each has the keys event, frame, time, steps, dt,
particles, density_error, max_speed, volume, triangles and files; what is not known at that
moment is null. Events are started, progress, frame, warning, finished, interrupted and error.
A frame's line comes when its files are complete.";

/// Options of `run`.
#[derive(Debug, Args)]
#[command(after_help = RUN_EXAMPLES)]
pub struct RunArguments {
    /// Scene file (TOML), or the name of one that comes with the program
    #[arg(value_name = "SCENE", required_unless_present = "resume")]
    pub scene: Option<PathBuf>,
    /// Go on with a run that was stopped: its output folder, or a checkpoint file
    #[arg(long, value_name = "DIR|FILE", conflicts_with = "scene")]
    pub resume: Option<PathBuf>,
    /// Write a checkpoint every N frames, from which the run can go on; the last two are kept
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub checkpoint_every: Option<u32>,
    /// Folder for the results [default: out/ and the scene's name]
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// auto (the best GPU, else the CPU), gpu, cpu, or a part of an adapter's name from `splashdown doctor`
    /// [default: auto, or what the run that goes on was given]
    #[arg(short, long, value_name = "auto|gpu|cpu|NAME", value_parser = clap::value_parser!(Device))]
    pub device: Option<Device>,
    /// Number of frames after the initial one [default: the scene's]
    #[arg(short = 'n', long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub frames: Option<u32>,
    /// File formats instead of the scene's, separated by commas; `none` writes no particles and no meshes
    #[arg(short, long, value_name = "LIST", value_delimiter = ',', value_parser = choice_or_none::<Format>())]
    pub formats: Option<Vec<Option<Format>>>,
    /// Do not extract the surface: no meshes, no pictures of it
    #[arg(long)]
    pub no_surface: bool,
    /// Pictures instead of the scene's, separated by commas; a missing driver is then an error
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = choice::<PictureKind>())]
    pub pictures: Option<Vec<PictureKind>>,
    /// Draw no pictures
    #[arg(long, conflicts_with = "pictures")]
    pub no_pictures: bool,
    /// Make no film of the pictures
    #[arg(long)]
    pub no_film: bool,
    /// Measure the time of every pass and print it at the end
    #[arg(long)]
    pub timing: bool,
    /// Print one JSON object per line to stdout
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub verbosity: VerbosityArguments,
}
