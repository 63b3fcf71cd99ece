//! `splashdown bench`: the time of a step, by number of particles and by pass, and how far it is from what
//! the device can do, as Markdown or JSON.

use std::collections::BTreeMap;
use std::time::Duration;

use serde::Serialize;
use splashdown::{Device, Simulation};
use splashdown_gpu::Timings;
use splashdown_gpu::floors::Floors;

use crate::args::BenchArguments;
use crate::exit::Failure;
use crate::report::{PassNumbers, passes};
use crate::speed::{bench_scene, seconds_per_step};
use crate::{console, human, memory, summary};

/// Steps before the first measurement: the lattice gives way, pipelines are built, buffers find their size.
const WARM_UP: u32 = 30;

/// Measurements, of which the median counts: other programs disturb some of them.
const ROUNDS: usize = 5;

/// How long all rounds of one size should take together.
const BUDGET: Duration = Duration::from_secs(2);

/// What a step must at least move and compute per particle, with about 28 neighbours: every array once, in a step whose passes are joined as far as
/// they can be; and the arithmetic of tests, density and forces. docs/performance.md derives both.
const FLOOR_BYTES: f64 = 192.0;
const FLOOR_OPERATIONS: f64 = 6047.0;
/// Sizes of `--compare`: from 8,192 particles up to as many as fit, or as take so long per step.
const COMPARED: (u32, u32) = (13, 30);
const LONGEST_STEP: f64 = 2.0;
/// Particles of whose neighbours the mean is told.
const SAMPLED: usize = 256;

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
    /// Mean number of neighbours within the support radius.
    neighbours: f64,
    /// Bytes in the simulation's buffers.
    memory: u64,
    /// The shortest time that this device could take, in s.
    floor: f64,
    /// `seconds_per_step` over `floor`.
    over_floor: f64,
    /// What the floor is made of.
    copy_bytes_per_second: f64,
    flops: f64,
    dispatch_seconds: f64,
    dispatches_per_step: f64,
    passes: BTreeMap<&'static str, PassNumbers>,
    #[serde(skip)]
    timings: Timings,
    #[serde(skip)]
    timed_steps: u64,
}

/// Measures, and prints.
pub fn run(arguments: &BenchArguments) -> Result<(), Failure> {
    let mut rows: Vec<Row> = Vec::new();
    let floors = Floors::measure(&mut arguments.device.device.executor()?)?;
    let compared: Vec<u32> = (COMPARED.0..=COMPARED.1).map(|power| 1 << power).collect();
    let sizes = if arguments.compare { &compared } else { &arguments.particles };
    for &particles in sizes {
        if arguments.compare
            && let Some(end) = too_large(particles, &rows, &arguments.device.device)
        {
            if !arguments.json {
                console::print(format!("\n{} particles: {end}.", human::count(particles.into())));
            }
            break;
        }
        let row = match measure(particles, arguments, floors) {
            // A device tells what it cannot hold when it is asked to.
            Err(failure) if arguments.compare && !rows.is_empty() => {
                if !arguments.json {
                    console::print(format!("\n{} particles: {failure}", human::count(particles.into())));
                }
                break;
            }
            row => row?,
        };
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

/// Why the next size of a comparison is not measured.
fn too_large(particles: u32, rows: &[Row], device: &Device) -> Option<String> {
    let last = rows.last()?;
    let next = last.seconds_per_step * f64::from(particles) / last.particles as f64;
    if next > LONGEST_STEP {
        return Some(format!("not measured, a step would take {next:.1} s"));
    }
    let scene = bench_scene(particles).ok()?;
    memory::check(&scene, device).err().map(|error| format!("do not fit: {error}"))
}

/// The mean number of particles within the support radius of one, itself left out, over a few of them.
fn neighbours(positions: &[[f32; 3]], support_radius: f32) -> f64 {
    let sampled = positions.iter().step_by((positions.len() / SAMPLED).max(1));
    let (mut found, mut count) = (0_u64, 0_u64);
    for x in sampled {
        let near = |y: &&[f32; 3]| {
            let square: f32 = x.iter().zip(*y).map(|(a, b)| (a - b) * (a - b)).sum();
            square < support_radius * support_radius
        };
        found += positions.iter().filter(near).count() as u64 - 1;
        count += 1;
    }
    found as f64 / count.max(1) as f64
}

fn measure(particles: u32, arguments: &BenchArguments, floors: Floors) -> Result<Row, Failure> {
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
    let dispatches: u64 = timings.passes.values().map(|time| time.count).sum();
    let dispatches = if timed_steps > 0 { dispatches as f64 / f64::from(timed_steps) } else { 0.0 };
    let (bytes, operations) = (FLOOR_BYTES * count as f64, FLOOR_OPERATIONS * count as f64);
    // The floor of the dispatches that there are: fewer of them would lower it.
    let floor = floors.seconds(bytes, operations, dispatches);
    let support_radius = simulation.params().support_radius;
    let positions = simulation.particles()?.positions;
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
        neighbours: neighbours(&positions, support_radius),
        memory: simulation.memory(),
        floor,
        over_floor: seconds / floor,
        copy_bytes_per_second: floors.bytes_per_second,
        flops: floors.flops,
        dispatch_seconds: floors.dispatch,
        dispatches_per_step: dispatches,
        passes: passes(&timings),
        timings,
        timed_steps: timed_steps.into(),
    })
}

fn header(row: &Row) -> String {
    format!(
        "`{}` on {}: median of {} rounds after {WARM_UP} steps.\n\n\
         Measured floors: copies {}/s, {:.0} GFLOP/s, {:.2} us per dependent dispatch.\n\n\
         | particles | neighbours | memory | ms per step | fastest | ns per particle | particle-steps/s | over the floor |\n\
         |---:|---:|---:|---:|---:|---:|---:|---:|",
        row.solver,
        row.device,
        row.rounds,
        human::bytes(row.copy_bytes_per_second as u64),
        1e-9 * row.flops,
        1e6 * row.dispatch_seconds
    )
}

fn line(row: &Row) -> String {
    format!(
        "| {} | {:.1} | {} | {:.3} | {:.3} | {:.1} | {} | {:.1} |",
        human::count(row.particles),
        row.neighbours,
        human::bytes(row.memory),
        1e3 * row.seconds_per_step,
        1e3 * row.fastest,
        row.nanoseconds_per_particle,
        human::scaled(row.particle_steps_per_second).trim_end(),
        row.over_floor
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

#[cfg(test)]
mod tests {
    use super::neighbours;

    #[test]
    fn neighbours_on_a_lattice_are_counted() {
        let lattice: Vec<[f32; 3]> =
            (0..27).map(|i| [(i % 3) as f32, (i / 3 % 3) as f32, (i / 9) as f32]).collect();
        // The middle has six, a face five, an edge four, a corner three.
        assert!((neighbours(&lattice, 1.1) - (6.0 + 6.0 * 5.0 + 12.0 * 4.0 + 8.0 * 3.0) / 27.0).abs() < 1e-9);
        assert_eq!(neighbours(&lattice[..1], 1.1), 0.0);
    }
}
