//! Measures surface reconstruction per pass, with `splashsurf_lib` for comparison in the same run:
//! `cargo run --release -p splashdown --example surface_times -- [POINTS.npy SPACING]`
//!
//! Without a file of positions it first simulates the dam break up to 0.2 s.

use std::path::Path;
use std::time::{Duration, Instant};

use splashdown::scene::{Scene, SurfaceKernels};
use splashdown::surface::{SurfaceParams, interpolate, reconstruct_with};
use splashdown::{Device, Simulation};
use splashdown_gpu::Executor;
use splashdown_io::npy;
use splashsurf_lib::nalgebra::Vector3;

const ROUNDS: usize = 9;

fn median(mut times: Vec<Duration>) -> f64 {
    times.sort_unstable();
    1e3 * times[times.len() / 2].as_secs_f64()
}

fn timed<T>(mut work: impl FnMut() -> T) -> f64 {
    let time = |_| {
        let start = Instant::now();
        work();
        start.elapsed()
    };
    median((0..ROUNDS).map(time).collect())
}

type Failure = Box<dyn std::error::Error>;

/// Positions and particle spacing in metres.
fn input() -> Result<(Vec<[f32; 3]>, f32), Failure> {
    let mut arguments = std::env::args().skip(1);
    if let Some(file) = arguments.next() {
        let spacing =
            arguments.next().ok_or("give the particles' spacing in metres after the file")?.parse()?;
        return Ok((npy::read_positions(Path::new(&file))?, spacing));
    }
    let scene = Scene::parse(include_str!("../scenes/dam-break.toml"), "dam-break")?;
    let mut simulation = Simulation::new(&scene, &Device::Auto)?;
    simulation.advance(0.2)?;
    Ok((simulation.particles()?.positions, scene.fluid.particle_spacing))
}

#[expect(clippy::print_stdout, reason = "an example that prints")]
fn main() -> Result<(), Failure> {
    let (points, spacing) = input()?;
    use SurfaceKernels::{Anisotropic, Isotropic};
    for (cell_ratio, smoothing_iterations, kernels) in [
        (0.5, 0, Isotropic),
        (0.5, 0, Anisotropic),
        (0.5, 25, Isotropic),
        (0.25, 0, Isotropic),
        (0.25, 0, Anisotropic),
    ] {
        let params = {
            let mut params = SurfaceParams::new(spacing);
            params.cell_size = cell_ratio * spacing;
            params.smoothing_iterations = smoothing_iterations;
            params.kernels = kernels;
            params
        };
        println!(
            "{} particles, {kernels} kernels, cells of {cell_ratio} spacings, {smoothing_iterations} smoothing iterations",
            points.len()
        );
        for name in ["cpu", "llvmpipe"] {
            let Ok(executor) = name.parse::<Device>().unwrap_or_default().executor() else {
                println!("  {name}: not available");
                continue;
            };
            times(name, executor, &points, &params)?;
        }
        let theirs = splashsurf_lib::Parameters::new(spacing / 2.0, params.support_radius, params.cell_size);
        let points: Vec<_> = points.iter().map(|&p| Vector3::from(p)).collect();
        let total = timed(|| splashsurf_lib::reconstruct_surface::<i64, f32>(&points, &theirs));
        println!("  splashsurf_lib, without smoothing and normals: {total:.1} ms");
    }
    Ok(())
}

#[expect(clippy::print_stdout, reason = "an example that prints")]
fn times(
    name: &str,
    mut executor: Executor,
    points: &[[f32; 3]],
    params: &SurfaceParams,
) -> Result<(), Failure> {
    let total = timed(|| reconstruct_with(points, params, &mut executor));
    let vertices = reconstruct_with(points, params, &mut executor)?.0.vertices;
    let velocities = timed(|| interpolate(&vertices, points, points, params));
    println!("  {name}: {} vertices, their velocities (on the CPU) in {velocities:.1} ms", vertices.len());
    executor.enable_timing();
    reconstruct_with(points, params, &mut executor)?;
    let timings = executor.take_timings();
    println!(
        "  {name}: {total:.1} ms with sorting and read-back; passes {:.1} ms:",
        1e3 * timings.total().as_secs_f64()
    );
    for (label, time) in &timings.passes {
        println!("    {label:20} {:8.2} ms", 1e3 * time.total.as_secs_f64());
    }
    Ok(())
}
