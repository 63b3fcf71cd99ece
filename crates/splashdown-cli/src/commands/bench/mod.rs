//! `splashdown bench`: the time of a step, by number of particles, by threads and by pass, and its ratio to the roofline
//! of the device, as Markdown or JSON.

mod measure;
mod page;

use serde::Serialize;
use splashdown::Device;
use splashdown::scene::Scene;
use splashdown_gpu::roofline::Roofline;

use crate::args::BenchArguments;
use crate::exit::{Exit, Failure};
use crate::speed::bench_scene;
use crate::{console, human, memory, scene_file};
use measure::{Row, measure};

/// The smallest and the largest size of `--compare` as powers of two.
const COMPARED: (u32, u32) = (13, 30);

/// `--compare` does not measure longer steps than this, in s.
const LONGEST_STEP: f64 = 2.0;

/// A size that was not measured, in the JSON output.
#[derive(Debug, Serialize)]
struct Missing<'a> {
    particles: u32,
    error: &'a str,
}

/// Measures and prints.
pub fn run(arguments: &BenchArguments) -> Result<(), Failure> {
    let mut rows = Vec::new();
    if arguments.threads.is_empty() {
        all_sizes(arguments, &mut rows)?;
    }
    for &threads in &arguments.threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(|error| {
            Failure::new(Exit::Failed, format!("cannot start {threads} threads: {error}"))
        })?;
        pool.install(|| all_sizes(arguments, &mut rows))?;
    }
    if !arguments.json {
        console::print(page::closing(&rows, arguments.no_passes));
    }
    Ok(())
}

/// Measures all sizes with the current number of threads.
fn all_sizes(arguments: &BenchArguments, rows: &mut Vec<Row>) -> Result<(), Failure> {
    let device = &arguments.device.device;
    let roofline = Roofline::measure(&mut device.executor()?)?;
    if let Some(path) = &arguments.scene {
        return one_size(scene_file::load(path)?, arguments, roofline, rows);
    }
    let compared: Vec<u32> = (COMPARED.0..=COMPARED.1).map(|power| 1 << power).collect();
    let sizes = if arguments.compare { &compared } else { &arguments.particles };
    let before = rows.len();
    for &particles in sizes {
        let outcome = match too_large(particles, &rows[before..], device) {
            Some(reason) if arguments.compare => Err(Failure::new(Exit::Device, reason)),
            _ => bench_scene(particles)
                .map_err(Failure::from)
                .and_then(|scene| one_size(scene, arguments, roofline, rows)),
        };
        // A comparison ends at the first size that does not fit the device or takes too long.
        match outcome {
            Err(failure) if arguments.compare && rows.len() > before => {
                missing(particles, &failure.message, arguments.json);
                break;
            }
            outcome => outcome?,
        }
    }
    Ok(())
}

/// Measures one scene and prints its row.
fn one_size(
    mut scene: Scene,
    arguments: &BenchArguments,
    roofline: Roofline,
    rows: &mut Vec<Row>,
) -> Result<(), Failure> {
    if let Some(solver) = arguments.solver {
        scene.solver.select_method(solver);
    }
    let row = measure(&scene, arguments, roofline)?;
    if arguments.json {
        console::print_json(&row);
    } else {
        // All rows with the same number of threads share a heading.
        if rows.last().is_none_or(|last| last.device != row.device) {
            console::print(page::header(&row, !rows.is_empty()));
        }
        console::print(page::line(&row));
    }
    rows.push(row);
    Ok(())
}

/// Why the next size of a comparison is not measured.
fn too_large(particles: u32, rows: &[Row], device: &Device) -> Option<String> {
    let last = rows.last()?;
    let next = last.seconds_per_step * f64::from(particles) / last.particles as f64;
    if next > LONGEST_STEP {
        return Some(format!("not measured: a step would take {next:.1} s"));
    }
    memory::check(&bench_scene(particles).ok()?, device).err().map(|error| error.message)
}

/// Prints the size at which a comparison ends, and the reason.
fn missing(particles: u32, error: &str, json: bool) {
    if json {
        console::print_json(&Missing { particles, error });
    } else {
        console::print(format!("\n{} particles: {error}", human::count(particles.into())));
    }
}
