//! Options of `surface`.

use std::path::PathBuf;

use clap::Args;
use splashdown::scene::SurfaceKernels;
use splashdown_io::Format;

use super::{DeviceArgument, choice, is_mesh_file, limit, whole};

/// The examples, and the formats in the order of their table.
fn after_help() -> String {
    format!(
        "\
{EXAMPLES}

Input formats:   {}
Output formats:  {}
Velocities of particles are interpolated to the vertices ({}). Other attributes
(a number or a vector per particle) are interpolated with --attribute ({}). With
several input files, each mesh has the number of its input file, in place of * or before the ending.

Lengths are in the unit of the files. With equal parameters the surface is that of splashsurf, whose
particle radius is half of the particle spacing.",
        Format::endings(Format::reads_particles).join(" "),
        Format::endings(is_mesh_file).join(" "),
        Format::endings(|format| is_mesh_file(format) && format.has_velocities()).join(" "),
        Format::endings(Format::has_attributes).join(" "),
    )
}

const EXAMPLES: &str = "\
Examples:
  splashdown surface particles.vtk -o water.ply --particle-spacing 0.02
  splashdown surface 'frames/ParticleData_*.bgeo' -o meshes/ --particle-spacing 0.05 --smoothing 20
  splashdown surface hot.vtu -o hot.vtk --particle-spacing 0.01 -a temperature -a density
  splashdown surface splash.ply -o splash.obj --particle-spacing 0.02 --min-blob 9 --droplets drops.ply
  splashdown surface out/my/particles -o 'meshes/water_*.glb'";

/// Options of `surface`.
#[derive(Debug, Args)]
#[command(after_help = after_help())]
pub struct SurfaceArguments {
    /// Particle files, patterns with * and ?, or a folder with one series of files
    #[arg(value_name = "PARTICLES", required = true)]
    pub particles: Vec<PathBuf>,
    /// Output mesh; for several files a folder, or a name in which * becomes the number
    #[arg(short, long, value_name = "MESH")]
    pub out: PathBuf,
    /// Distance between neighbouring particles in the bulk of the fluid [default: that in the file, as in files of runs]
    #[arg(short = 's', long, value_name = "S", allow_negative_numbers = true, value_parser = length)]
    pub particle_spacing: Option<f32>,
    /// Use the spacing even if it does not fit the particles
    #[arg(long)]
    pub force: bool,
    /// Kernels of the particles: `anisotropic` gives smoother films and jets, and drops of the right volume
    #[arg(short, long, value_name = "KERNELS", value_parser = choice::<SurfaceKernels>(), default_value = "isotropic")]
    pub kernels: SurfaceKernels,
    /// Edge of a marching-cubes cell [default: half a spacing]
    #[arg(short, long, value_name = "C", allow_negative_numbers = true, value_parser = length)]
    pub cell_size: Option<f32>,
    /// Distance at which the kernel becomes zero [default: two spacings]
    #[arg(long, value_name = "R", allow_negative_numbers = true, value_parser = length)]
    pub support_radius: Option<f32>,
    /// Value of the density field at the surface; it is about 1 in the bulk and 0 outside
    #[arg(long, value_name = "LEVEL", allow_negative_numbers = true, default_value_t = 0.6)]
    pub iso_level: f32,
    /// Iterations of smoothing; 15 to 25 remove the bumps of single particles and preserve the volume
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 0, value_parser = whole(0..=1000))]
    pub smoothing: u32,
    /// Leave particles in blobs of fewer than N particles out of the mesh
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 0, value_parser = whole(0..=1_000_000_000))]
    pub min_blob: u32,
    /// Leave particles with fewer than N others within 0.9 support radii out of the mesh
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 0, value_parser = limit())]
    pub min_neighbours: u32,
    /// Write the particles that are left out, with their diameter; named as the meshes
    #[arg(long, value_name = "FILE")]
    pub droplets: Option<PathBuf>,
    /// Interpolate this attribute of the particles to the vertices, or `all` of them; may be repeated
    #[arg(short, long, value_name = "NAME|all")]
    pub attribute: Vec<String>,
    #[command(flatten)]
    pub device: DeviceArgument,
    /// Print one JSON object per mesh to stdout
    #[arg(long)]
    pub json: bool,
    /// Print errors only
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
