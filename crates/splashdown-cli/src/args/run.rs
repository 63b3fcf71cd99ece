//! Options of `run`.

use std::path::PathBuf;

use clap::Args;
use splashdown::Device;
use splashdown::scene::{self, OnBurst, PictureKind, PictureQuality};
use splashdown_io::Format;

use super::{VerbosityArguments, choice, choice_or_none, is_mesh_file, limit, whole};

/// The examples and the output files.
fn after_help() -> String {
    let with_velocities = Format::endings(|format| is_mesh_file(format) && format.has_velocities()).join(" ");
    format!(
        "\
Examples:
  splashdown run scenes/dam-break.toml
  splashdown run dam-break --device cpu --frames 20 --no-pictures
  splashdown run my.toml --out out/test --formats vtu,obj --pictures surface
  splashdown run my.toml --checkpoint-every 10
  splashdown run --resume out/my
  splashdown run my.toml --json | jq 'select(.event == \"frame\") | .density_error'

Files in the output folder:
  particles/particles_0000.ply, ...      one file per frame
  mesh/surface_0000.ply, ...             the closed surface of the fluid; its vertices have
                                         velocities in {with_velocities}
  droplets/droplets_0000.ply, ...        isolated particles, which are not part of the surface, with
                                         velocities and diameter
  scene.usdc, scene.glb                  all frames of surface, droplets, foam and bodies, with tank,
                                         camera and materials, with --formats usd,glb; written at
                                         the end, until then in checkpoints/scene.scenepart
  particles.usdc                         all frames of the particles, with --formats usd
  particles/particles.pvd, mesh/surface.pvd, ...
                                         the times of the .vtu or .vtp files of a series, for ParaView
  pictures/surface_0000.png, particles_0000.png
  surface.mp4, particles.mp4             if ffmpeg is installed
  checkpoints/checkpoint_0010.splashdown to resume from; written after Ctrl-C and with
                                         --checkpoint-every; numpy.load opens them
  run.json                               the summary, the energy balance and all alarms
Every file is complete or absent. Frames of an earlier run in the same folder are removed.
A resumed run keeps the settings of the original run, except those given again. If all frames
are complete, --resume completes the film, the scene files and run.json.

With --json, stdout has one object per line. Each has the keys event, frame, time, steps, dt,
particles, density_error, max_speed, volume, triangles and files; unknown values are null.
Events are started, progress, frame, warning, finished, interrupted and error. A frame is
reported when its files are complete."
    )
}

/// Options of `run`.
#[derive(Debug, Args)]
#[command(after_help = after_help())]
pub struct RunArguments {
    /// Scene file (TOML), or the name of a built-in scene
    #[arg(value_name = "SCENE", required_unless_present = "resume")]
    pub scene: Option<PathBuf>,
    /// Resume a run from its output folder or a checkpoint file
    #[arg(long, value_name = "DIR|FILE", conflicts_with = "scene")]
    pub resume: Option<PathBuf>,
    /// Write a checkpoint to resume from every N frames; only the last two are kept on disk
    #[arg(long, value_name = "N", value_parser = whole(1..=1_000_000))]
    pub checkpoint_every: Option<u32>,
    /// Output folder [default: out/ and the scene's name]
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// auto (the best GPU, else the CPU), gpu, cpu, or part of an adapter's name from `splashdown doctor`
    /// [default: auto, or the device of the resumed run]
    #[arg(short, long, value_name = "auto|gpu|cpu|NAME", value_parser = clap::value_parser!(Device))]
    pub device: Option<Device>,
    /// Number of frames after the initial one [default: the scene's]
    #[arg(short = 'n', long, value_name = "N", value_parser = whole(1..=1_000_000))]
    pub frames: Option<u32>,
    /// File formats, separated by commas, overriding the scene; `none` writes no particles or meshes
    #[arg(short, long, value_name = "LIST", value_delimiter = ',', value_parser = choice_or_none::<scene::Format>())]
    pub formats: Option<Vec<Option<scene::Format>>>,
    /// Do not extract the surface: no meshes and no pictures of it
    #[arg(long)]
    pub no_surface: bool,
    /// Particles in blobs of fewer than N leave the surface and become droplets; 0: none [default: the scene's]
    #[arg(long, value_name = "N", value_parser = limit())]
    pub min_blob: Option<u32>,
    /// Particles with fewer than N others within 0.9 support radii leave the surface and become droplets; 0: none
    /// [default: the scene's]
    #[arg(long, value_name = "N", value_parser = limit())]
    pub min_neighbours: Option<u32>,
    /// Pictures, separated by commas, overriding the scene; a missing driver is then an error
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = choice::<PictureKind>())]
    pub pictures: Option<Vec<PictureKind>>,
    /// Draw no pictures
    #[arg(long, conflicts_with = "pictures")]
    pub no_pictures: bool,
    /// How carefully pictures of the surface are drawn, overriding the scene
    #[arg(long, value_name = "QUALITY", value_parser = choice::<PictureQuality>())]
    pub quality: Option<PictureQuality>,
    /// Make no films of the pictures
    #[arg(long)]
    pub no_film: bool,
    /// Do not flush each file to the disk: quicker on slow disks, but a power failure can destroy the newest files
    #[arg(long)]
    pub no_sync: bool,
    /// When the fluid bursts, that is when speeds, energy or densities become meaningless [default: stop, or the choice of
    /// the resumed run]
    #[arg(long, value_name = "stop|warn|ignore", value_parser = choice::<OnBurst>())]
    pub on_burst: Option<OnBurst>,
    /// Measure the time of every pass of the simulation and of the pictures, and print it at the end
    #[arg(long)]
    pub timing: bool,
    /// Print one JSON object per line to stdout
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub verbosity: VerbosityArguments,
}
