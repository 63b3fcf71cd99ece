//! Checkpoints of a run, and resuming from one.

use serde::{Deserialize, Serialize};
use splashdown_gpu::block_on;
use web_time::Instant;

use super::{Run, RunOptions, Stage};
use crate::error::CheckpointError;
use crate::monitor::SavedMonitor;
use crate::scene::Scene;
use crate::{Checkpoint, Simulation, SimulationError};

/// The state of a run in addition to that of its simulation, stored in checkpoints.
#[derive(Serialize, Deserialize)]
struct RunState {
    frame: u32,
    density: [f32; 2],
    volume: Option<[f64; 2]>,
    particle_volume: f64,
    watched: Vec<bool>,
    monitor: SavedMonitor,
}

/// The largest number of frames.
const MAX_FRAMES: u32 = 100_000_000;

/// The entry of this state in a checkpoint.
const ENTRY: &str = "run.bin";

impl Run {
    /// Resumes from a checkpoint, whose scene must be given. Earlier frames are not returned again. A checkpoint made
    /// within a frame resumes with the rest of that frame.
    ///
    /// # Errors
    /// As [`Simulation::resume`].
    pub fn resume(
        checkpoint: &Checkpoint,
        scene: &Scene,
        options: RunOptions,
    ) -> Result<Self, SimulationError> {
        let started = Instant::now();
        let executor = options.device.executor()?;
        let simulation =
            block_on(Simulation::resume_async(checkpoint, executor, &options.report_progress()))?;
        let time = simulation.stats().time;
        let mut run = Self::of(simulation, scene, options, started)?;
        if let (Some(foam), Some(saved)) = (&mut run.foam, checkpoint.foam()?) {
            run.simulation.restore_foam(foam, &saved)?;
        }
        let rate = f64::from(scene.frame_rate);
        let state = match checkpoint.has(ENTRY) {
            true => checkpoint.get::<Option<RunState>>(ENTRY)?,
            false => None,
        };
        let frame = match state {
            Some(state) if state.frame > MAX_FRAMES => {
                let reason = format!("its frame is {}, more than {MAX_FRAMES}", state.frame);
                return Err(CheckpointError::Malformed(reason).into());
            }
            Some(state) => {
                let frame = state.frame;
                run.restore(state, time)?;
                run.complete = Some(frame);
                frame
            }
            // A checkpoint from the window, which has no frames. The tolerance of a millionth of a frame
            // covers rounding.
            None => {
                let frame = (time * rate + 1e-6).floor();
                run.next_duration = Some(((frame + 1.0) / rate - time) as f32);
                frame as u32
            }
        };
        run.first = frame;
        Ok(run)
    }

    /// The state after the last [`Event::Frame`](super::Event::Frame), to resume from. Call it before the next event is
    /// requested.
    ///
    /// # Errors
    /// As [`Simulation::checkpoint`].
    pub fn checkpoint(&mut self) -> Result<Checkpoint, SimulationError> {
        let mut checkpoint = self.simulation.checkpoint(&self.scene_text)?;
        if let Some(foam) = &self.foam {
            checkpoint.set_foam(&block_on(self.simulation.keep_foam_async(foam))?);
        }
        // Within a frame there is no state of a complete frame to resume from.
        let between = !matches!(self.stage, Stage::Steps(_) | Stage::Fetch(_));
        let state = self.complete.filter(|_| between).map(|frame| RunState {
            frame,
            density: self.density,
            volume: self.volume,
            particle_volume: self.particle_volume,
            watched: self.watched.clone(),
            monitor: self.monitor.save(),
        });
        checkpoint.set(ENTRY, &state);
        Ok(checkpoint)
    }

    fn restore(&mut self, state: RunState, time: f64) -> Result<(), SimulationError> {
        let RunState { density, volume, particle_volume, watched, monitor, .. } = state;
        (self.density, self.volume, self.particle_volume) = (density, volume, particle_volume);
        self.watched = watched;
        let particles = self.simulation.particles()?;
        let bodies = self.simulation.body_states()?;
        self.monitor.restore(monitor, time, &particles, &bodies);
        Ok(())
    }
}
