//! The expected wall time of a run, from the first part of the same scene with fewer particles.
//!
//! Speeds and iterations depend on the scene, so that they cannot be derived from the scene file: honey flows a hundred
//! times slower than water falls. A trial with a wider spacing measures them. Its time steps are then scaled to the spacing
//! of the scene, and its cost per particle to the number of particles of the scene, with that of a dam break at both sizes.

use std::time::{Duration, Instant};

use serde::Serialize;
use splashdown::check::Resolution;
use splashdown::scene::{Derived, Method, Scene};
use splashdown::{Device, Simulation, SimulationError, Stats, longest_step};

use crate::exit::Failure;
use crate::speed::{bench_scene, seconds_per_step};

/// Particles of the trial: sufficient to use a CPU fully, and few enough to simulate a part of most scenes in the given time.
const TRIAL: f64 = 4096.0;
/// Larger trials would take too long to build. They occur where thin fluid prevents a wider spacing.
const LARGEST_TRIAL: f64 = 65_536.0;
/// Particles at which the cost per particle is measured: a GPU needs many.
const MANY: f64 = 65_536.0;
/// The wall time of the trial, and the shortest of a measurement of the cost.
const TRIAL_TIME: Duration = Duration::from_millis(1500);
const COST_TIME: Duration = Duration::from_millis(60);
/// The fewest measurements of the cost, of four steps each. The first steps of a large simulation cost up to four times as
/// much: its memory is new, and the pressure is far from that of the flow.
const FEWEST_BATCHES: u32 = 5;
/// The least number of spacings across the thinnest fluid and the domain in the trial.
const THINNEST: f32 = 4.0;
/// The shortest step of a measured scene in s.
const SHORTEST_STEP: f32 = 1e-9;

/// What a trial says about the whole run.
pub struct Forecast {
    pub device: String,
    /// The number of steps of the run.
    pub steps: u64,
    /// The wall time in s, without pictures and files.
    pub seconds: f64,
    /// Particle steps per second at the size of the scene.
    pub rate: f64,
    /// `None` if the scene allows no trial: the forecast then follows from the expected speed and from a dam break.
    pub trial: Option<Trial>,
}

/// The size of a trial.
#[derive(Debug, Serialize)]
pub struct Trial {
    pub particles: u32,
    /// The part of the scene's duration that it covers.
    pub part: f64,
}

/// Runs the trial.
///
/// # Errors
/// Those of the device. A trial that fails otherwise is replaced by the estimate from the scene file.
pub fn forecast(
    scene: &Scene,
    derived: &Derived,
    resolution: &Resolution,
    device: &Device,
) -> Result<Forecast, Failure> {
    let particles = derived.mean_particles.max(1.0);
    let whole = cost(scene, particles.min(MANY), device)?;
    let ratio = coarsening(scene, resolution, particles);
    let count = particles / f64::from(ratio).powi(3);
    let trial = (count <= LARGEST_TRIAL).then(|| run(&coarse(scene, ratio), device));
    let Some(Ok(trial)) = trial.filter(|trial| trial.as_ref().is_ok_and(|trial| trial.frames > 0)) else {
        let steps = derived.steps_estimate;
        return Ok(Forecast {
            device: whole.device,
            steps,
            seconds: particles * steps as f64 * whole.seconds,
            rate: 1.0 / whole.seconds,
            trial: None,
        });
    };
    let part = cost(scene, count.max(1.0), device)?;
    // A cache or a wider GPU changes the cost per particle by a factor of a few at most.
    let per_particle = trial.seconds / trial.particle_steps * (whole.seconds / part.seconds);
    let later = f64::from(derived.frames - trial.frames);
    let steps = trial.steps(scene, derived, ratio);
    let total = steps.iter().sum::<f64>() + later * late_mean(&steps);
    Ok(Forecast {
        device: whole.device,
        steps: total.round() as u64,
        seconds: particles * total * per_particle,
        rate: 1.0 / per_particle,
        trial: Some(Trial {
            particles: trial.particles,
            part: f64::from(trial.frames) / f64::from(derived.frames),
        }),
    })
}

/// The mean of the second half of the values.
fn late_mean(values: &[f64]) -> f64 {
    let late = &values[values.len() / 2..];
    late.iter().sum::<f64>() / late.len().max(1) as f64
}

/// The spacing of the trial over that of the scene.
fn coarsening(scene: &Scene, resolution: &Resolution, particles: f64) -> f32 {
    // The particles of a file have their own spacing.
    if !scene.fluid.files.is_empty() {
        return 1.0;
    }
    let widest = scene.domain.size().min_element() / scene.fluid.particle_spacing;
    let thinnest = resolution.fluid.iter().map(|piece| piece.spacings).fold(widest, f32::min);
    ((particles / TRIAL).cbrt() as f32).min(thinnest / THINNEST).max(1.0)
}

/// The scene with a wider spacing.
fn coarse(scene: &Scene, ratio: f32) -> Scene {
    let mut coarse = scene.clone();
    coarse.fluid.particle_spacing *= ratio;
    coarse.probes.clear();
    coarse.solver.min_dt = SHORTEST_STEP;
    for emitter in &mut coarse.emitters {
        let fewer = |count: u32| ((count as f32 / ratio.powi(3)) as u32).max(1);
        emitter.max_particles = emitter.max_particles.map(fewer);
    }
    coarse
}

/// The first frames of a run.
struct Start {
    particles: u32,
    frames: u32,
    /// Per frame.
    stats: Vec<Stats>,
    particle_steps: f64,
    seconds: f64,
    /// The longest step that does not depend on speeds, in s.
    longest: f32,
}

fn run(scene: &Scene, device: &Device) -> Result<Start, SimulationError> {
    let mut simulation = Simulation::new(scene, device)?;
    let particles = simulation.stats().particles;
    // The first step also builds pipelines.
    seconds_per_step(&mut simulation, 1)?;
    let (start, mut stats, mut particle_steps) = (Instant::now(), Vec::new(), 0.0);
    while stats.len() < scene.frame_count() as usize && start.elapsed() < TRIAL_TIME {
        let frame = simulation.advance(scene.frame_duration())?;
        particle_steps += f64::from(frame.particles) * f64::from(frame.steps_in_frame);
        stats.push(frame);
    }
    Ok(Start {
        particles: particles.max(simulation.stats().particles),
        frames: stats.len() as u32,
        stats,
        // An emitter may not have created any particle yet.
        particle_steps: particle_steps.max(1.0),
        seconds: start.elapsed().as_secs_f64(),
        longest: longest_step(scene),
    })
}

impl Start {
    /// The steps of each frame in a scene whose spacing is `ratio` times smaller.
    fn steps(&self, scene: &Scene, derived: &Derived, ratio: f32) -> Vec<f64> {
        let frame = scene.frame_duration();
        let longest = longest_step(scene).min(frame);
        let here = self.longest.min(frame);
        let by_speed = |stats: &Stats| match scene.solver.method {
            Method::Dfsph => scene.solver.cfl_factor * scene.fluid.particle_spacing / stats.max_speed,
            _ => derived.dt_estimate,
        };
        let steps = self.stats.iter().map(|stats| {
            let step = frame / stats.steps_in_frame.max(1) as f32;
            // Limits by speed and sound are proportional to the spacing. Other limits determine the steps of the trial if
            // these are as long as the longest.
            let step = if step > 0.9 * here { by_speed(stats) } else { step / ratio };
            f64::from((frame / step.min(longest)).ceil())
        });
        steps.collect()
    }
}

/// The cost of a step of a dam break.
struct Cost {
    device: String,
    /// The wall time in s per particle and step.
    seconds: f64,
}

fn cost(scene: &Scene, particles: f64, device: &Device) -> Result<Cost, Failure> {
    let mut small = bench_scene(particles as u32)?;
    small.solver = scene.solver.clone();
    // The default follows the size of the domain, and a GPU encodes all iterations.
    small.solver.max_iterations = Some(Derived::max_iterations(scene));
    // The dam break moves faster than some scenes, and must not end at their shortest step.
    small.solver.min_dt = SHORTEST_STEP;
    let mut simulation = Simulation::new(&small, device)?;
    // The first steps also build pipelines and touch memory for the first time.
    seconds_per_step(&mut simulation, 2)?;
    let start = Instant::now();
    let (mut best, mut batches) = (f64::INFINITY, 0);
    while batches < FEWEST_BATCHES || start.elapsed() < COST_TIME {
        best = best.min(seconds_per_step(&mut simulation, 4)?.0);
        batches += 1;
    }
    let measured = f64::from(simulation.stats().particles.max(1));
    Ok(Cost { device: simulation.device_name(), seconds: best / measured })
}
