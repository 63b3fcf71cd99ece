//! How much to simulate next, so that the fluid keeps up with the clock where the machine can, and the window
//! with the user where it cannot.

use std::time::Duration;

use web_time::Instant;

/// Wall time between two snapshots that a slow machine may take, in s.
const PATIENCE: f64 = 0.03;
/// What is simulated at once on a fast machine, in s of wall time.
const BEAT: f64 = 1.0 / 120.0;
/// What a machine that is behind does not catch up with, in s of wall time.
const FORGIVEN: f64 = 0.05;

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
    /// Wall seconds from the end of a tick to the next, lately.
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

    /// The clock stands still.
    pub fn pause(&mut self) {
        self.last = None;
        self.due = 0.0;
    }

    /// Simulated seconds to compute now, if it is time; `least` is what a step takes.
    pub fn tick(&mut self, now: Instant, least: f64) -> Option<f64> {
        let passed = self.last.replace(now).map_or(0.0, |last| (now - last).as_secs_f64());
        // Slow motion may ask for less than a step per beat.
        let beat = (BEAT * self.scale).max(least);
        self.due = (self.due + passed * self.scale).min((FORGIVEN * self.scale).max(beat));
        if self.due < beat {
            return None;
        }
        // A slow driver may take long for a picture: half of the time is the simulation's all the same.
        let patience = self.between.max(PATIENCE);
        let affordable = if self.cost > 0.0 { patience / self.cost } else { beat };
        let tick = self.due.min(affordable).max(least);
        self.due -= tick;
        Some(tick)
    }

    /// Learns what a tick took, and what was done between it and the next.
    pub fn learn(&mut self, simulated: f64, wall: Duration, between: Duration) {
        let cost = wall.as_secs_f64() / simulated.max(1e-9);
        self.cost = if self.cost > 0.0 { 0.8 * self.cost + 0.2 * cost } else { cost };
        self.between = (0.8 * self.between + 0.2 * between.as_secs_f64()).min(0.25);
    }

    /// Forgets what ticks took: another scene.
    pub fn forget(&mut self) {
        self.cost = 0.0;
        self.pause();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Simulated seconds after this many wall seconds, and the longest tick, on a machine with this cost, and
    /// this much to do between two ticks.
    fn run(scale: f64, cost: f64, between: f64, seconds: f64) -> (f64, f64) {
        let mut pace = Pace::new();
        pace.set_scale(scale);
        let (start, mut wall, mut simulated, mut longest) = (Instant::now(), 0.0, 0.0, 0.0_f64);
        while wall < seconds {
            match pace.tick(start + Duration::from_secs_f64(wall), 1e-4) {
                Some(tick) => {
                    let took = tick * cost;
                    pace.learn(tick, Duration::from_secs_f64(took), Duration::from_secs_f64(between));
                    (wall, simulated) = (wall + took + between, simulated + tick);
                    longest = longest.max(took);
                }
                None => wall += 0.001,
            }
        }
        (simulated, longest)
    }

    #[test]
    fn a_fast_machine_keeps_time_and_a_slow_one_slows_down_in_short_ticks() {
        let (fast, _) = run(1.0, 0.2, 0.0, 2.0);
        assert!((fast - 2.0).abs() < 0.05, "{fast}");
        let (slow_motion, _) = run(0.1, 0.2, 0.0, 2.0);
        assert!((slow_motion - 0.2).abs() < 0.01, "{slow_motion}");
        // A step every second and a half.
        let (slower, _) = run(1e-4 / 1.5, 0.2, 0.0, 6.0);
        assert!((slower - 4e-4).abs() < 1.1e-4, "{slower}");
        let (slow, longest) = run(1.0, 20.0, 0.0, 5.0);
        // All that the machine can do, and the window hears of it often.
        assert!((slow - 5.0 / 20.0).abs() < 0.02, "{slow}");
        assert!(longest < 0.2, "{longest}");
        // Pictures that take long leave half of the time.
        let (beside, longest) = run(1.0, 20.0, 0.1, 5.0);
        assert!((beside - 2.5 / 20.0).abs() < 0.02, "{beside}");
        assert!(longest < 0.2, "{longest}");
    }
}
