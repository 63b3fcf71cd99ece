//! Options of `bench`.

use std::path::PathBuf;

use clap::Args;
use splashdown::scene::Method;

use super::{DeviceArgument, choice, whole};
use crate::human;

const EXAMPLES: &str = "\
Examples:
  splashdown bench
  splashdown bench --particles 8K,16K,32K,64K,128K,256K,512K,1M --device cpu
  splashdown bench --particles 64K --device llvmpipe --steps 10
  splashdown bench --particles 64K --device cpu --threads 1,2,4 --no-passes
  splashdown bench --scene my.toml --json";

/// Options of `bench`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct BenchArguments {
    /// Numbers of particles, separated by commas; K and M are powers of 1024 (64K = 65,536)
    #[arg(short, long, value_name = "LIST", value_delimiter = ',', default_value = "64K", value_parser = human::parse_count)]
    pub particles: Vec<u32>,
    #[command(flatten)]
    pub device: DeviceArgument,
    /// Number of steps to measure [default: as many as fit into about two seconds]
    #[arg(short, long, value_name = "N", value_parser = whole(1..=1_000_000))]
    pub steps: Option<u32>,
    /// Solver to measure: wcsph, dfsph or mueller2003 [default: wcsph, or the scene's]
    #[arg(short = 'm', long, value_parser = choice::<Method>())]
    pub solver: Option<Method>,
    /// Scene to measure instead of the benchmark's dam break: a file, or the name of a built-in scene
    #[arg(long, value_name = "SCENE", conflicts_with_all = ["particles", "compare"])]
    pub scene: Option<PathBuf>,
    /// Double the number of particles from 8K to the largest that fits
    #[arg(long, conflicts_with = "particles")]
    pub compare: bool,
    /// Numbers of CPU threads, separated by commas [default: all]
    #[arg(short, long, value_name = "LIST", value_delimiter = ',', value_parser = threads)]
    pub threads: Vec<usize>,
    /// Do not measure the passes separately
    #[arg(long)]
    pub no_passes: bool,
    /// Run shaders without bounds checks, to measure the cost of the checks
    #[arg(long)]
    pub unchecked_shaders: bool,
    /// Print one JSON object per number of particles
    #[arg(long)]
    pub json: bool,
}

/// A number of threads.
fn threads(text: &str) -> Result<usize, String> {
    let allowed = |threads: &usize| (1..=1024).contains(threads);
    text.trim()
        .parse()
        .ok()
        .filter(allowed)
        .ok_or_else(|| "a number of threads is a whole number from 1 to 1024".to_owned())
}
