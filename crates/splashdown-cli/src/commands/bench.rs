//! `splashdown bench`: the time of a step, by number of particles and by pass, as Markdown.

use std::collections::BTreeMap;
use std::time::Duration;

use serde::Serialize;
use splashdown::{Device, Simulation};
use splashdown_gpu::Timings;

use crate::args::BenchArguments;
use crate::exit::Failure;
use crate::report::{PassNumbers, passes};
use crate::speed::{bench_scene, seconds_per_step};
use crate::{console, human, summary};

/// Steps before the first measurement: the lattice gives way, pipelines are built, buffers find their size.
const WARM_UP: u32 = 30;

/// Measurements, of which the median counts: other programs disturb some of them.
const ROUNDS: usize = 5;

/// How long all rounds of one size should take together.
const BUDGET: Duration = Duration::from_secs(2);

/// The measurement of one size.
#[derive(Debug, Serialize)]
struct Row {
    device: String,
    solver: String,
    particles: u64,
    rounds: usize,
    steps_per_round: u32,
    /// Median over the rounds, in s.
    seconds_per_step: f64,
    /// The fastest round, in s.
    fastest: f64,
    nanoseconds_per_particle: f64,
    particle_steps_per_second: f64,
    passes: BTreeMap<&'static str, PassNumbers>,
    #[serde(skip)]
    timings: Timings,
    #[serde(skip)]
    timed_steps: u64,
}

/// Measures, and prints.
pub fn run(arguments: &BenchArguments) -> Result<(), Failure> {
    let mut rows = Vec::new();
    for &particles in &arguments.particles {
        let row = measure(particles, arguments)?;
        if arguments.json {
            console::print_json(&row);
        } else {
            if rows.is_empty() {
                console::print(header(&row));
            }
            console::print(line(&row));
        }
        rows.push(row);
    }
    if !arguments.json {
        console::print(closing(&rows, arguments.no_passes));
    }
    Ok(())
}

fn measure(particles: u32, arguments: &BenchArguments) -> Result<Row, Failure> {
    let mut scene = bench_scene(particles)?;
    scene.solver.method = arguments.solver;
    let device: &Device = &arguments.device.device;
    let mut simulation = Simulation::new(&scene, device)?;
    let (each, _) = seconds_per_step(&mut simulation, WARM_UP)?;
    let steps = arguments.steps.unwrap_or_else(|| {
        let fitting = BUDGET.as_secs_f64() / ROUNDS as f64 / each.max(1e-9);
        (fitting as u32).clamp(2, 10_000)
    });
    let mut rounds = Vec::with_capacity(ROUNDS);
    for _ in 0..ROUNDS {
        rounds.push(seconds_per_step(&mut simulation, steps)?.0);
    }
    rounds.sort_by(f64::total_cmp);
    let seconds = rounds[ROUNDS / 2];
    let mut timed_steps = 0;
    if !arguments.no_passes && simulation.enable_timing() {
        timed_steps = seconds_per_step(&mut simulation, steps)?.1;
    }
    let timings = simulation.take_timings();
    let count = u64::from(simulation.stats().particles);
    Ok(Row {
        device: simulation.device_name(),
        solver: scene.solver.method.to_string(),
        particles: count,
        rounds: ROUNDS,
        steps_per_round: steps,
        seconds_per_step: seconds,
        fastest: rounds[0],
        nanoseconds_per_particle: 1e9 * seconds / count as f64,
        particle_steps_per_second: count as f64 / seconds,
        passes: passes(&timings),
        timings,
        timed_steps: timed_steps.into(),
    })
}

fn header(row: &Row) -> String {
    format!(
        "`{}` on {}: median of {} rounds after {WARM_UP} steps.\n\n\
         | particles | ms per step | fastest | ns per particle | particle-steps/s |\n|---:|---:|---:|---:|---:|",
        row.solver, row.device, row.rounds
    )
}

fn line(row: &Row) -> String {
    format!(
        "| {} | {:.3} | {:.3} | {:.1} | {} |",
        human::count(row.particles),
        1e3 * row.seconds_per_step,
        1e3 * row.fastest,
        row.nanoseconds_per_particle,
        human::scaled(row.particle_steps_per_second).trim_end()
    )
}

fn closing(rows: &[Row], no_passes: bool) -> String {
    let mut text = String::new();
    let costs = || rows.iter().map(|row| row.nanoseconds_per_particle);
    if rows.len() > 1 {
        let ratio = costs().fold(0.0, f64::max) / costs().fold(f64::INFINITY, f64::min);
        text += &format!("\nCost per particle, the largest over the smallest: {ratio:.2}\n");
    }
    for row in rows.iter().filter(|row| !no_passes && row.timed_steps > 0) {
        text += &format!(
            "\n{} particles, by pass:\n\n{}\n",
            human::count(row.particles),
            summary::passes(&row.timings, row.timed_steps)
        );
    }
    text
}
