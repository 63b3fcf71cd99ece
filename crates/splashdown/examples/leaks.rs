//! Counts leaks over ten seconds of every built-in scene: particles inside a body, particles outside a closed side, and
//! particles that were moved back inside (allowed in the first second, until the initial state has relaxed).
//!
//! `cargo run --release -p splashdown --example leaks -- [SCENE ...] [--device cpu|gpu|NAME] [--seconds S]
//! [--spacing-factor F]`
//!
//! A spacing factor of 2 doubles the particle spacing, which makes the study about thirty times shorter. The exit code is
//! 1 if there was a leak.

use std::process::ExitCode;
use std::time::Instant;

use splashdown::scene::{Scene, presets};
use splashdown::{Device, Simulation, SimulationError};

struct Options {
    scenes: Vec<String>,
    device: Device,
    seconds: f32,
    factor: f32,
}

fn options() -> Result<Options, String> {
    let mut options = Options { scenes: Vec::new(), device: Device::Cpu, seconds: 10.0, factor: 1.0 };
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut value = || arguments.next().ok_or(format!("{argument} needs a value"));
        match argument.as_str() {
            "--device" => {
                options.device = value()?.parse().map_err(|error| format!("--device: {error}"))?;
            }
            "--seconds" => {
                options.seconds = value()?.parse().map_err(|error| format!("--seconds: {error}"))?
            }
            "--spacing-factor" => {
                options.factor = value()?.parse().map_err(|error| format!("--spacing-factor: {error}"))?;
            }
            option if option.starts_with('-') => return Err(format!("unknown option {option}")),
            name => options.scenes.push(name.to_owned()),
        }
    }
    if options.scenes.is_empty() {
        options.scenes = presets().iter().map(|(name, _)| (*name).to_owned()).collect();
    }
    Ok(options)
}

/// The counts of one scene.
#[derive(Default)]
struct Count {
    particles: u32,
    /// Largest number of particles inside a body, sampled every 0.1 s.
    inside: u32,
    outside: u32,
    early_corrections: u32,
    late_corrections: u32,
    non_finite: u32,
    density_error: f32,
}

fn count(scene: &Scene, options: &Options) -> Result<Count, SimulationError> {
    let mut simulation = Simulation::new(scene, &options.device)?;
    let mut count = Count::default();
    for tenth in 1..=(10.0 * options.seconds).ceil() as u32 {
        let stats = simulation.advance(0.1)?;
        let particles = simulation.particles()?;
        let domain = &scene.domain;
        let is_outside = |x: &[f32; 3]| {
            (0..3).any(|axis| {
                domain.closed[axis][0] && x[axis] < domain.min[axis]
                    || domain.closed[axis][1] && x[axis] > domain.max[axis]
            })
        };
        count.particles = count.particles.max(stats.particles);
        count.outside =
            count.outside.max(particles.positions.iter().filter(|x| is_outside(x)).count() as u32);
        count.inside = count.inside.max(simulation.inside_bodies(&particles)?);
        count.density_error = count.density_error.max(stats.density_error);
        count.non_finite = stats.non_finite;
        if tenth <= 10 {
            count.early_corrections = stats.wall_corrections;
        }
        count.late_corrections = stats.wall_corrections - count.early_corrections;
    }
    Ok(count)
}

#[expect(clippy::print_stdout, clippy::print_stderr, reason = "an example that prints")]
fn main() -> ExitCode {
    let options = match options() {
        Ok(options) => options,
        Err(message) => {
            eprintln!("error: {message}");
            return ExitCode::from(2);
        }
    };
    println!(
        "| scene | particles | inside | outside | moved back in 1 s | and later | NaN | density error | wall time |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|");
    let mut leaks = 0;
    for name in &options.scenes {
        let Some((_, text)) = presets().iter().find(|(known, _)| known == name) else {
            eprintln!("error: unknown scene {name}; `splashdown scenes` lists all scenes");
            return ExitCode::from(2);
        };
        let begun = Instant::now();
        let outcome = Scene::parse(text, name).map_err(|errors| errors.to_string()).and_then(|mut scene| {
            scene.fluid.particle_spacing *= options.factor;
            // The buffers have capacity for emitters over the whole study.
            scene.duration = options.seconds;
            count(&scene, &options).map_err(|error| error.to_string())
        });
        match outcome {
            Ok(count) => {
                println!(
                    "| {name} | {} | {} | {} | {} | {} | {} | {:.1} % | {:.0} s |",
                    count.particles,
                    count.inside,
                    count.outside,
                    count.early_corrections,
                    count.late_corrections,
                    count.non_finite,
                    100.0 * count.density_error,
                    begun.elapsed().as_secs_f64()
                );
                leaks += count.inside + count.outside + count.late_corrections + count.non_finite;
            }
            Err(message) => {
                println!("| {name} | {message} |");
                leaks += 1;
            }
        }
    }
    if leaks > 0 { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}
