//! The command line: one declaration gives the parser, the help and the shells' completions.

use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{ArgAction, Args, Parser, Subcommand};
use clap_complete::Shell;
use splashdown::Device;
use splashdown::scene::{Choice, Format, PictureKind};

use crate::console::Verbosity;
use crate::{exit, human};

/// Fast SPH water on any GPU, from a scene file to particles, a watertight mesh and a picture.
#[derive(Debug, Parser)]
#[command(name = "splashdown", version, max_term_width = 100, after_help = exit::HELP)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The words after `splashdown`.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Simulate a scene and write its frames
    Run(RunArguments),
    /// Open a window to watch a scene and to play with it
    View(ViewArguments),
    /// Validate a scene and print what follows from it, without simulating
    Check(CheckArguments),
    /// List the devices of this machine, what fits on them, and what is missing
    Doctor(DoctorArguments),
    /// List, show or copy the scenes that come with the program
    Scenes(ScenesArguments),
    /// Make meshes of anybody's particles
    Surface(SurfaceArguments),
    /// Draw what probes have measured
    Plot(PlotArguments),
    /// Measure the time of a step, by pass and by number of particles
    Bench(BenchArguments),
    /// Print completions for a shell
    Completions(CompletionsArguments),
}

/// Options of `view`.
#[derive(Debug, Args)]
pub struct ViewArguments {
    /// Scene file (TOML), the name of one that comes with the program, or a checkpoint to go on from
    #[arg(value_name = "SCENE", default_value = "dam-break")]
    pub scene: PathBuf,
    #[command(flatten)]
    pub device: DeviceArgument,
    /// Width and height of the window
    #[arg(long, value_name = "WxH", default_value = "1280x800", value_parser = window_size)]
    pub size: [f32; 2],
}

/// Two numbers with an x between them.
fn window_size(text: &str) -> Result<[f32; 2], String> {
    let side = |side: &str| side.parse().ok().filter(|side| (200.0..=16_384.0).contains(side));
    match text.split_once('x').map(|(width, height)| (side(width), side(height))) {
        Some((Some(width), Some(height))) => Ok([width, height]),
        _ => {
            Err("a size is two numbers between 200 and 16384 with an x between them, such as 1280x800"
                .to_owned())
        }
    }
}

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
    #[command(flatten)]
    pub device: DeviceArgument,
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

/// How much is said.
#[derive(Debug, Args)]
pub struct VerbosityArguments {
    /// Say nothing but errors
    #[arg(short, long, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Also say what the library remarks
    #[arg(short, long, action = ArgAction::SetTrue)]
    pub verbose: bool,
}

impl VerbosityArguments {
    /// As a level.
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
    /// auto (the best GPU, else the CPU), gpu, cpu, or a part of an adapter's name from `splashdown doctor`
    #[arg(short, long, value_name = "auto|gpu|cpu|NAME", default_value = "auto", value_parser = clap::value_parser!(Device))]
    pub device: Device,
}

const CHECK_EXAMPLES: &str = "\
Examples:
  splashdown check scenes/dam-break.toml
  splashdown check my.toml --json

The expected time is an estimate: a few steps of a small scene are measured on this machine.";

/// Options of `check`.
#[derive(Debug, Args)]
#[command(after_help = CHECK_EXAMPLES)]
pub struct CheckArguments {
    /// Scene file (TOML), or the name of one that comes with the program
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

const SCENES_EXAMPLES: &str = "\
Examples:
  splashdown scenes                       list them
  splashdown scenes show honey            print one
  splashdown scenes copy dam-break        write dam-break.toml here, to change it
  splashdown scenes schema > scene.schema.json";

/// Options of `scenes`.
#[derive(Debug, Args)]
#[command(after_help = SCENES_EXAMPLES)]
pub struct ScenesArguments {
    /// What to do; without a word, the list.
    #[command(subcommand)]
    pub action: Option<ScenesAction>,
}

/// The words after `splashdown scenes`.
#[derive(Debug, Subcommand)]
pub enum ScenesAction {
    /// List names and what the scenes are (the default)
    List,
    /// Print a scene file
    Show {
        /// Name of the scene
        name: String,
    },
    /// Copy a scene file, to change it
    Copy {
        /// Name of the scene
        name: String,
        /// File or folder to write to
        #[arg(default_value = ".")]
        destination: PathBuf,
        /// Replace a file that is there
        #[arg(short, long)]
        force: bool,
    },
    /// Print the JSON schema of scene files, for completion in an editor
    Schema,
    /// Print a table of all keys of a scene file, in Markdown
    Reference,
}

const SURFACE_EXAMPLES: &str = "\
Examples:
  splashdown surface particles.vtk -o water.ply --particle-spacing 0.02
  splashdown surface 'frames/ParticleData_*.bgeo' -o meshes/ --particle-spacing 0.05 --smoothing 20
  splashdown surface out/dam-break/particles -o 'meshes/water_*.glb' --particle-spacing 0.02

Particles are read from PLY, VTK, VTU, VTP, BGEO, NPY, NPZ and XYZ; meshes are written as PLY, OBJ,
STL, VTK or GLB. Where particles have velocities, so have the vertices (PLY, VTK, GLB). The meshes of
several files have the numbers of their files, at the place of the star or before the ending.

Lengths are in the unit of the files. With equal parameters the surface is that of splashsurf, whose
particle radius is half of the particle spacing.";

/// Options of `surface`.
#[derive(Debug, Args)]
#[command(after_help = SURFACE_EXAMPLES)]
pub struct SurfaceArguments {
    /// Files of particles, patterns with * and ?, or a folder with one series of files
    #[arg(value_name = "PARTICLES", required = true)]
    pub particles: Vec<PathBuf>,
    /// File for the mesh; for several a folder, or a name whose * becomes the number
    #[arg(short, long, value_name = "MESH")]
    pub out: PathBuf,
    /// Distance of the particles in the fluid's bulk
    #[arg(short = 's', long, value_name = "S", value_parser = length)]
    pub particle_spacing: Option<f32>,
    /// Use a spacing that does not fit the particles all the same
    #[arg(long)]
    pub force: bool,
    /// Edge of a marching-cubes cell [default: half a spacing]
    #[arg(short, long, value_name = "C", value_parser = length)]
    pub cell_size: Option<f32>,
    /// Distance from which on a particle is not felt [default: two spacings]
    #[arg(long, value_name = "R", value_parser = length)]
    pub support_radius: Option<f32>,
    /// The field's value at the surface; it is about 1 in the bulk and 0 outside
    #[arg(long, value_name = "LEVEL", default_value_t = 0.6)]
    pub iso_level: f32,
    /// Rounds of smoothing; 15 to 25 remove the particles' bumps and keep the volume
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=1000))]
    pub smoothing: u32,
    /// Leave out separate pieces smaller than this many particles in the bulk; lone particles count 1 to 2
    #[arg(long, value_name = "N", default_value_t = 0.0, value_parser = particles_of_a_blob)]
    pub min_blob: f64,
    #[command(flatten)]
    pub device: DeviceArgument,
    /// Print one JSON object per mesh to stdout
    #[arg(long)]
    pub json: bool,
    /// Say nothing but errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// A length above zero.
fn length(text: &str) -> Result<f32, String> {
    text.parse()
        .ok()
        .filter(|length| (1e-12..=1e12).contains(length))
        .ok_or_else(|| "a length is a number above 0, such as 0.02".to_owned())
}

/// A number of particles, which need not be whole.
fn particles_of_a_blob(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|size: &f64| (0.0..=1e12).contains(size))
        .ok_or_else(|| "the smallest blob is a number of particles, 0 or more".to_owned())
}

const PLOT_EXAMPLES: &str = "\
Examples:
  splashdown plot out/dam-break/probes/*.csv -o probes.svg
  splashdown plot left.csv right.csv -o heights.png --title 'Height of the water' --size 1200x500

A table has a line of names, the first of which is that of the time, and rows of numbers. Columns of
one unit share a panel. Tables can be drawn while the run that writes them goes on.";

/// Options of `plot`.
#[derive(Debug, Args)]
#[command(after_help = PLOT_EXAMPLES)]
pub struct PlotArguments {
    /// Tables as probes write them (CSV)
    #[arg(value_name = "TABLE", required = true)]
    pub tables: Vec<PathBuf>,
    /// Picture to write: .svg or .png
    #[arg(short, long, value_name = "FILE")]
    pub out: PathBuf,
    /// Words above the plot
    #[arg(long, value_name = "TEXT")]
    pub title: Option<String>,
    /// Width and height in pixels [default: 900, and 260 for each unit]
    #[arg(long, value_name = "WxH", value_parser = picture_size)]
    pub size: Option<(u32, u32)>,
}

/// Two whole numbers with an x between them.
fn picture_size(text: &str) -> Result<(u32, u32), String> {
    let side = |side: &str| side.parse().ok().filter(|side| (100..=16_384).contains(side));
    match text.split_once('x').map(|(width, height)| (side(width), side(height))) {
        Some((Some(width), Some(height))) => Ok((width, height)),
        _ => Err("a size is two whole numbers between 100 and 16384 with an x between them, such as 900x600"
            .to_owned()),
    }
}

const BENCH_EXAMPLES: &str = "\
Examples:
  splashdown bench
  splashdown bench --particles 8K,16K,32K,64K,128K,256K,512K,1M --device cpu
  splashdown bench --particles 64K --device llvmpipe --steps 10";

/// Options of `bench`.
#[derive(Debug, Args)]
#[command(after_help = BENCH_EXAMPLES)]
pub struct BenchArguments {
    /// Numbers of particles, separated by commas (64K = 65,536)
    #[arg(short, long, value_name = "LIST", value_delimiter = ',', default_value = "64K", value_parser = human::parse_count)]
    pub particles: Vec<u32>,
    #[command(flatten)]
    pub device: DeviceArgument,
    /// Steps to measure [default: as many as take about two seconds]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub steps: Option<u32>,
    /// Solver to measure: wcsph or mueller2003
    #[arg(short = 'm', long, default_value = "wcsph", value_parser = choice::<splashdown::scene::Method>())]
    pub solver: splashdown::scene::Method,
    /// Measure from 8K particles to as many as fit, doubling: how does the cost grow?
    #[arg(long, conflicts_with = "particles")]
    pub compare: bool,
    /// Do not split the time by pass (measuring each pass costs a little on a GPU)
    #[arg(long)]
    pub no_passes: bool,
    /// Print one JSON object per number of particles
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

/// Reads one word of a choice of the scene file; help and completions list the words.
fn choice<C: Choice + Send + Sync>() -> impl TypedValueParser<Value = C> {
    words::<C>(&[]).try_map(|word| C::from_name(&word).ok_or("unknown word"))
}

/// As [`choice`], with the word `none` for nothing.
fn choice_or_none<C: Choice + Send + Sync>() -> impl TypedValueParser<Value = Option<C>> {
    words::<C>(&["none"]).map(|word| C::from_name(&word))
}

fn words<C: Choice>(more: &[&'static str]) -> PossibleValuesParser {
    let words = C::ALL.iter().map(|&(_, word, about)| PossibleValue::new(word).help(about.trim()));
    PossibleValuesParser::new(words.chain(more.iter().map(|word| PossibleValue::new(word).help("Nothing."))))
}
