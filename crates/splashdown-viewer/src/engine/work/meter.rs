//! Measuring the speed of the simulation.

use std::sync::Arc;
use std::time::Duration;

use splashdown::{Simulation, SimulationError};
use splashdown_gpu::Timings;
use web_time::Instant;

/// The time between two measurements.
const MEASURE: Duration = Duration::from_millis(500);
/// The mean height is computed for at most this many particles.
const MAX_PARTICLES: u32 = 20_000;

/// Recent speeds and times.
pub(super) struct Meter {
    since: Instant,
    steps: u64,
    simulated: f64,
    pub steps_per_second: f64,
    pub speed: f64,
    pub timings: Arc<Timings>,
    pub timed_steps: u64,
    pub mean_height: f32,
}

impl Meter {
    pub fn new() -> Self {
        Self {
            since: Instant::now(),
            steps: 0,
            simulated: 0.0,
            steps_per_second: 0.0,
            speed: 0.0,
            timings: Arc::default(),
            timed_steps: 0,
            mean_height: f32::NAN,
        }
    }

    pub async fn count(
        &mut self,
        steps: u32,
        simulated: f64,
        simulation: &mut Simulation,
    ) -> Result<(), SimulationError> {
        self.steps += u64::from(steps);
        self.simulated += simulated;
        let passed = self.since.elapsed();
        if passed >= MEASURE {
            self.steps_per_second = self.steps as f64 / passed.as_secs_f64();
            self.speed = self.simulated / passed.as_secs_f64();
            self.timings = Arc::new(simulation.take_timings());
            self.timed_steps = self.steps;
            if simulation.stats().particles <= MAX_PARTICLES {
                let positions = simulation.particles_async().await?.positions;
                let heights = positions.iter().map(|x| f64::from(x[1]));
                self.mean_height = (heights.sum::<f64>() / positions.len().max(1) as f64) as f32;
            }
            (self.since, self.steps, self.simulated) = (Instant::now(), 0, 0.0);
        }
        Ok(())
    }

    pub fn pause(&mut self) {
        let (timings, timed_steps, mean_height) =
            (Arc::clone(&self.timings), self.timed_steps, self.mean_height);
        *self = Self { timings, timed_steps, mean_height, ..Self::new() };
    }
}
