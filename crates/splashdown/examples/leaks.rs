//! Counts what must never happen, over ten seconds of every scene that comes with the program: particles inside
//! a body or outside a closed side, and particles that had to be put back (allowed in the first second, while a
//! scene settles).
//!
//! `cargo run --release -p splashdown --example leaks -- [SCENE ...] [--device cpu|gpu|NAME] [--seconds S]
//! [--spacing-factor F]`
//!
//! A factor of 2 makes the particles twice as large and the study thirty times as short. The exit code is 1 if anything
//! leaked.

use std::process::ExitCode;
use std::time::Instant;

use splashdown::scene::{Scene, presets};
use splashdown::{Device, Simulation, SimulationError};

struct Wishes {
    scenes: Vec<String>,
    device: Device,
    seconds: f32,
    factor: f32,
}

fn wishes() -> Result<Wishes, String> {
    let mut wishes = Wishes { scenes: Vec::new(), device: Device::Cpu, seconds: 10.0, factor: 1.0 };
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut value = || arguments.next().ok_or(format!("{argument} needs a value"));
        match argument.as_str() {
            "--device" => {
                wishes.device = value()?.parse().map_err(|error| format!("--device: {error}"))?;
            }
            "--seconds" => {
                wishes.seconds = value()?.parse().map_err(|error| format!("--seconds: {error}"))?
            }
            "--spacing-factor" => {
                wishes.factor = value()?.parse().map_err(|error| format!("--spacing-factor: {error}"))?;
            }
            option if option.starts_with('-') => return Err(format!("there is no option {option}")),
            name => wishes.scenes.push(name.to_owned()),
        }
    }
    if wishes.scenes.is_empty() {
        wishes.scenes = presets().iter().map(|(name, _)| (*name).to_owned()).collect();
    }
    Ok(wishes)
}

/// What was counted in one scene.
#[derive(Default)]
struct Count {
    particles: u32,
    /// Most particles inside a body at the end of a tenth of a second.
    inside: u32,
    outside: u32,
    early_corrections: u32,
    late_corrections: u32,
    non_finite: u32,
    density_error: f32,
}

fn count(scene: &Scene, wishes: &Wishes) -> Result<Count, SimulationError> {
    let mut simulation = Simulation::new(scene, &wishes.device)?;
    let mut count = Count::default();
    for tenth in 1..=(10.0 * wishes.seconds).ceil() as u32 {
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
    let wishes = match wishes() {
        Ok(wishes) => wishes,
        Err(message) => {
            eprintln!("error: {message}");
            return ExitCode::from(2);
        }
    };
    println!(
        "| scene | particles | inside | outside | put back in 1 s | and later | NaN | density error | wall time |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|");
    let mut leaks = 0;
    for name in &wishes.scenes {
        let Some((_, text)) = presets().iter().find(|(known, _)| known == name) else {
            eprintln!("error: there is no scene {name}; `splashdown scenes` lists them");
            return ExitCode::from(2);
        };
        let begun = Instant::now();
        let outcome = Scene::parse(text, name).map_err(|errors| errors.to_string()).and_then(|mut scene| {
            scene.fluid.particle_spacing *= wishes.factor;
            // Emitters get room for the whole study.
            scene.duration = wishes.seconds;
            count(&scene, &wishes).map_err(|error| error.to_string())
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
