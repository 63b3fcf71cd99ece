//! The simulated time of the next tick: real time if the machine is fast enough, else as much as keeps the window
//! responsive.

use std::time::Duration;

use web_time::Instant;

/// Wall time between two snapshots on a slow machine, in s.
const MAX_TICK: f64 = 0.03;
/// Duration of a tick on a fast machine, in s of wall time.
const TICK: f64 = 1.0 / 120.0;
/// The largest delay that later ticks make up for, in s of wall time.
const MAX_DELAY: f64 = 0.05;

/// Turns wall time into simulated time.
#[derive(Debug)]
pub(super) struct Pace {
    /// Simulated seconds per second.
    scale: f64,
    /// Simulated seconds that are due.
    due: f64,
    last: Option<Instant>,
    /// Wall seconds per simulated second; 0 while unknown.
    cost: f64,
    /// Recent wall seconds between two ticks.
    between: f64,
}

impl Pace {
    pub fn new() -> Self {
        Self { scale: 1.0, due: 0.0, last: None, cost: 0.0, between: 0.0 }
    }

    pub fn set_scale(&mut self, scale: f64) {
        self.scale = scale;
        self.due = 0.0;
    }

    /// Stops the clock.
    pub fn pause(&mut self) {
        self.last = None;
        self.due = 0.0;
    }

    /// Simulated seconds to compute now, if a tick is due; `dt` is the duration of a step.
    pub fn tick(&mut self, now: Instant, dt: f64) -> Option<f64> {
        let passed = self.last.replace(now).map_or(0.0, |last| (now - last).as_secs_f64());
        // In slow motion TICK may be shorter than a step.
        let shortest = (TICK * self.scale).max(dt);
        self.due = (self.due + passed * self.scale).min((MAX_DELAY * self.scale).max(shortest));
        if self.due < shortest {
            return None;
        }
        // If drawing is slow, the simulation still gets half of the time.
        let longest_tick = self.between.max(MAX_TICK);
        let affordable = if self.cost > 0.0 { longest_tick / self.cost } else { shortest };
        // Whole steps: an implicit pressure is disturbed by a step of another length than the last.
        let tick = (self.due.min(affordable).max(dt) / dt).floor() * dt;
        self.due -= tick;
        Some(tick)
    }

    /// Records the wall time of a tick and the time until the next.
    pub fn record(&mut self, simulated: f64, wall: Duration, between: Duration) {
        let cost = wall.as_secs_f64() / simulated.max(1e-9);
        self.cost = if self.cost > 0.0 { 0.8 * self.cost + 0.2 * cost } else { cost };
        self.between = (0.8 * self.between + 0.2 * between.as_secs_f64()).min(0.25);
    }

    /// Clears the recorded times, for another scene.
    pub fn reset(&mut self) {
        self.cost = 0.0;
        self.pause();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Simulated seconds after some wall seconds, and the longest tick, on a machine with this cost and this time
    /// between two ticks.
    fn run(scale: f64, cost: f64, between: f64, seconds: f64) -> (f64, f64) {
        let mut pace = Pace::new();
        pace.set_scale(scale);
        let (start, mut wall, mut simulated, mut longest) = (Instant::now(), 0.0, 0.0, 0.0_f64);
        while wall < seconds {
            match pace.tick(start + Duration::from_secs_f64(wall), 1e-4) {
                Some(tick) => {
                    let took = tick * cost;
                    pace.record(tick, Duration::from_secs_f64(took), Duration::from_secs_f64(between));
                    (wall, simulated) = (wall + took + between, simulated + tick);
                    longest = longest.max(took);
                }
                None => wall += 0.001,
            }
        }
        (simulated, longest)
    }

    #[test]
    fn a_tick_is_a_whole_number_of_steps() {
        let (mut pace, start, dt) = (Pace::new(), Instant::now(), 0.0031);
        pace.record(dt, Duration::from_micros(100), Duration::ZERO);
        let ticks: Vec<f64> =
            (0..60).filter_map(|k| pace.tick(start + Duration::from_millis(16 * k), dt)).collect();
        assert!(ticks.iter().all(|tick| (tick / dt - (tick / dt).round()).abs() < 1e-9), "{ticks:?}");
        // Nothing is lost: what is left of a tick is due in the next one.
        let simulated: f64 = ticks.iter().sum();
        assert!((simulated - 59.0 * 0.016).abs() < dt, "{simulated}");
    }

    #[test]
    fn a_fast_machine_runs_in_real_time_and_a_slow_one_in_short_ticks() {
        let (fast, _) = run(1.0, 0.2, 0.0, 2.0);
        assert!((fast - 2.0).abs() < 0.05, "{fast}");
        let (slow_motion, _) = run(0.1, 0.2, 0.0, 2.0);
        assert!((slow_motion - 0.2).abs() < 0.01, "{slow_motion}");
        // One step every 1.5 s.
        let (slower, _) = run(1e-4 / 1.5, 0.2, 0.0, 6.0);
        assert!((slower - 4e-4).abs() < 1.1e-4, "{slower}");
        let (slow, longest) = run(1.0, 20.0, 0.0, 5.0);
        // The simulation runs as fast as the machine allows, in short ticks.
        assert!((slow - 5.0 / 20.0).abs() < 0.02, "{slow}");
        assert!(longest < 0.2, "{longest}");
        // Slow pictures leave half of the time.
        let (half, longest) = run(1.0, 20.0, 0.1, 5.0);
        assert!((half - 2.5 / 20.0).abs() < 0.02, "{half}");
        assert!(longest < 0.2, "{longest}");
    }
}
