//! Measuring one scene.

use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

use serde::Serialize;
use splashdown::Simulation;
use splashdown::scene::Scene;
use splashdown_gpu::Timings;
use splashdown_gpu::roofline::Roofline;
use splashdown_run::{PassNumbers, pass_numbers};

use crate::args::BenchArguments;
use crate::exit::{Exit, Failure};
use crate::memory;
use crate::speed::seconds_per_step;

/// Steps before the first measurement. The lattice relaxes, pipelines are compiled and buffers grow to their final
/// size in them.
pub const WARM_UP: u32 = 30;

/// Number of measurements. Their median is reported, because other programs slow some of them down.
const ROUNDS: usize = 5;

/// Total duration of the rounds of one size.
const BUDGET: Duration = Duration::from_secs(2);

/// Number of steps in which dispatches are counted if passes are not measured.
const COUNTED: u32 = 2;

/// Lower bounds of the memory traffic in bytes and of the arithmetic operations, per particle and step, with about 28
/// neighbours. The bytes count every array once, in a step whose passes are fused as far as possible. The operations
/// are those of distance tests, density and forces. docs/performance.md derives both.
const LEAST_BYTES: f64 = 192.0;
const LEAST_OPERATIONS: f64 = 6047.0;
/// Number of particles in the sample for the mean number of neighbours.
const SAMPLED: usize = 256;

/// The measurement of one size.
#[derive(Debug, Serialize)]
pub struct Row {
    pub device: String,
    pub solver: String,
    pub particles: u64,
    /// CPU threads.
    pub threads: usize,
    pub rounds: usize,
    pub steps_per_round: u32,
    /// Median over the rounds, in s.
    pub seconds_per_step: f64,
    /// The fastest round, in s.
    pub fastest: f64,
    pub nanoseconds_per_particle: f64,
    pub particle_steps_per_second: f64,
    /// The last time step over `seconds_per_step`.
    pub simulated_per_wall: f64,
    /// With an implicit pressure: iterations per step, the residual at which those of the last steps stopped, the tolerance,
    /// and the mean compression from the positions.
    pub pressure: Option<Pressure>,
    /// Particle spacing in m.
    pub spacing: f32,
    /// Where the kernel becomes zero, in m.
    pub support_radius: f32,
    /// Mean number of neighbours within the support radius.
    pub neighbours: f64,
    /// Bytes in the simulation's buffers.
    pub memory: u64,
    /// Peak resident bytes of this process so far, if the system reports them.
    pub peak_memory: Option<u64>,
    /// The shortest possible time of a step on this device, in s.
    pub roofline_seconds: f64,
    /// `seconds_per_step` over `roofline_seconds`.
    pub over_roofline: f64,
    /// The measured limits from which the roofline is computed.
    pub copy_bytes_per_second: f64,
    pub flops: f64,
    pub dispatch_seconds: f64,
    pub dispatches_per_step: f64,
    /// Number of steps over which the numbers of the passes are summed.
    pub timed_steps: u64,
    pub passes: BTreeMap<&'static str, PassNumbers>,
    #[serde(skip)]
    pub timings: Timings,
}

/// The iterations of an implicit pressure.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Pressure {
    pub iterations_per_step: f64,
    pub residual: f32,
    pub tolerance: f32,
    pub compression: f64,
    /// Steps that did not converge.
    pub unconverged: u32,
}

/// Measures a scene.
///
/// # Errors
/// Those of the simulation.
pub fn measure(scene: &Scene, arguments: &BenchArguments, roofline: Roofline) -> Result<Row, Failure> {
    let device = &arguments.device.device;
    let unchecked = arguments.unchecked_shaders;
    let executor = if unchecked {
        // SAFETY: only the simulation uses the executor.
        unsafe { device.unchecked_executor()? }
    } else {
        device.executor()?
    };
    if unchecked && executor.gpu().is_none() {
        let message = format!(
            "--unchecked-shaders needs a GPU, and `{device}` is not one: leave it out, or choose another --device"
        );
        return Err(Failure::new(Exit::Usage, message));
    }
    let mut simulation = Simulation::with_executor(scene, executor)?;
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
    // Passes are timed after the rounds, because timestamps around every pass take some time on a GPU. The roofline
    // needs the number of dispatches in any case.
    let mut timed_steps = 0;
    if simulation.enable_timing() {
        let steps = if arguments.no_passes { COUNTED.min(steps) } else { steps };
        timed_steps = seconds_per_step(&mut simulation, steps)?.1;
    }
    let timings = simulation.take_timings();
    let count = u64::from(simulation.stats().particles);
    let dispatches: u64 = timings.passes.values().map(|time| time.count).sum();
    let dispatches = if timed_steps > 0 { dispatches as f64 / f64::from(timed_steps) } else { 0.0 };
    let (bytes, operations) = (LEAST_BYTES * count as f64, LEAST_OPERATIONS * count as f64);
    // For the current number of dispatches. Fewer dispatches would lower it.
    let roofline_seconds = roofline.seconds(bytes, operations, dispatches);
    let support_radius = simulation.params().support_radius;
    let stats = simulation.stats();
    let pressure = (stats.iterations > 0).then(|| Pressure {
        iterations_per_step: stats.iterations as f64 / stats.steps.max(1) as f64,
        residual: stats.residual,
        tolerance: scene.solver.tolerance,
        compression: stats.mean_compression,
        unconverged: stats.unconverged,
    });
    let positions = simulation.particles()?.positions;
    Ok(Row {
        device: match simulation.gpu() {
            Some(gpu) if !gpu.checks_shaders() => format!("{}, shaders unchecked", gpu.name()),
            _ => simulation.device_name(),
        },
        solver: scene.solver.method.to_string(),
        particles: count,
        threads: rayon::current_num_threads(),
        rounds: ROUNDS,
        steps_per_round: steps,
        seconds_per_step: seconds,
        fastest: rounds[0],
        nanoseconds_per_particle: 1e9 * seconds / count as f64,
        particle_steps_per_second: count as f64 / seconds,
        simulated_per_wall: f64::from(stats.dt) / seconds,
        pressure,
        spacing: scene.fluid.particle_spacing,
        support_radius,
        neighbours: neighbours(&positions, support_radius),
        memory: simulation.memory(),
        peak_memory: memory::peak(),
        roofline_seconds,
        over_roofline: seconds / roofline_seconds,
        copy_bytes_per_second: roofline.bytes_per_second,
        flops: roofline.flops,
        dispatch_seconds: roofline.dispatch,
        dispatches_per_step: dispatches,
        timed_steps: timed_steps.into(),
        passes: if arguments.no_passes { BTreeMap::new() } else { pass_numbers(&timings) },
        timings,
    })
}

/// The mean number of neighbours within the support radius, over a sample of particles.
fn neighbours(positions: &[[f32; 3]], support_radius: f32) -> f64 {
    // A regular stride could be a multiple of the lattice's period and sample only particles at one wall.
    let golden = |k: usize| ((k as f64 * 0.618_033_988_75).fract() * positions.len() as f64) as usize;
    let sampled: BTreeSet<usize> = (0..SAMPLED).map(golden).collect();
    let (mut found, mut count) = (0_u64, 0_u64);
    for x in sampled.iter().filter_map(|&index| positions.get(index)) {
        let near = |y: &&[f32; 3]| {
            let square: f32 = x.iter().zip(*y).map(|(a, b)| (a - b) * (a - b)).sum();
            square < support_radius * support_radius
        };
        found += positions.iter().filter(near).count() as u64 - 1;
        count += 1;
    }
    found as f64 / count.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::neighbours;

    #[test]
    fn neighbours_on_a_lattice_are_counted() {
        let lattice: Vec<[f32; 3]> =
            (0..27).map(|i| [(i % 3) as f32, (i / 3 % 3) as f32, (i / 9) as f32]).collect();
        // The central particle has six neighbours, one on a face five, on an edge four, at a corner three.
        assert!((neighbours(&lattice, 1.1) - (6.0 + 6.0 * 5.0 + 12.0 * 4.0 + 8.0 * 3.0) / 27.0).abs() < 1e-9);
        assert_eq!(neighbours(&lattice[..1], 1.1), 0.0);
        assert_eq!(neighbours(&[], 1.1), 0.0);
    }

    #[test]
    fn the_sample_does_not_alias_with_a_lattice() {
        let side = 32;
        let lattice: Vec<[f32; 3]> = (0..side * side * side)
            .map(|i| [i % side, i / side % side, i / side / side].map(|c| c as f32))
            .collect();
        // Six, minus the neighbours that particles on the faces lack.
        let mean = 6.0 * (side - 1) as f64 / side as f64;
        let found = neighbours(&lattice, 1.1);
        assert!((found - mean).abs() < 0.1, "{found} instead of {mean}");
    }
}
