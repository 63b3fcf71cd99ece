//! Watching the simulation for bursts.

use std::time::Duration;

use splashdown::monitor::{Alarm, Level, Monitor};
use splashdown::{Simulation, SimulationError};
use web_time::Instant;

/// Wall time between two examinations.
const EVERY: Duration = Duration::from_millis(500);
/// Larger simulations are not examined, because reading their particles takes as long as drawing a picture.
const MAX_PARTICLES: u32 = 200_000;

/// Examines the simulation now and then. Its account of energy starts anew whenever the user has acted on the fluid.
#[derive(Default)]
pub(super) struct Watch {
    monitor: Option<Monitor>,
    last: Option<Instant>,
}

impl Watch {
    /// Starts anew, because something other than the scene has changed the motion.
    pub fn restart(&mut self) {
        self.monitor = None;
    }

    /// The warnings of an examination, if one is due, and whether the fluid has burst.
    pub async fn examine(
        &mut self,
        simulation: &mut Simulation,
    ) -> Result<(Vec<Alarm>, bool), SimulationError> {
        let is_due = self.last.is_none_or(|last| last.elapsed() >= EVERY);
        if !is_due || simulation.stats().particles > MAX_PARTICLES {
            return Ok((Vec::new(), false));
        }
        let monitor = self.monitor.get_or_insert_with(|| simulation.monitor());
        let mut alarms = simulation.examine_async(monitor).await?.alarms;
        alarms.retain(|alarm| alarm.level >= Level::Warning);
        let burst = alarms.iter().any(|alarm| alarm.level == Level::Stop);
        self.last = Some(Instant::now());
        Ok((alarms, burst))
    }
}
