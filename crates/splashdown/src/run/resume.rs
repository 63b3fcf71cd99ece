//! What a run keeps in checkpoints, and how it goes on from one.

use serde::{Deserialize, Serialize};
use splashdown_gpu::block_on;
use web_time::Instant;

use super::{Run, RunOptions, Stage};
use crate::scene::Scene;
use crate::{Checkpoint, CheckpointError, Simulation, SimulationError};

/// What a run remembers beside its simulation; part of a checkpoint.
#[derive(Serialize, Deserialize)]
struct Account {
    frame: u32,
    density_error: f32,
    volume: Option<[f64; 2]>,
    particle_volume: f64,
    watched: Vec<bool>,
}

/// Frames that a run can have.
const MOST_FRAMES: u32 = 100_000_000;

/// The name of the account in a checkpoint.
const ACCOUNT: &str = "run.bin";

impl Run {
    /// Goes on from a checkpoint, whose scene this is: frames that came before are not told again. A checkpoint
    /// that was not made at the end of a frame goes on with what is left of the frame that it was made in.
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
        if let (Some(foam), Some(kept)) = (&mut run.foam, checkpoint.foam()?) {
            run.simulation.restore_foam(foam, &kept)?;
        }
        let rate = f64::from(scene.frame_rate);
        let account = match checkpoint.has(ACCOUNT) {
            true => checkpoint.get::<Option<Account>>(ACCOUNT)?,
            false => None,
        };
        let frame = match account {
            Some(account) if account.frame > MOST_FRAMES => {
                let reason = format!("its frame is {}, more than {MOST_FRAMES}", account.frame);
                return Err(CheckpointError::Malformed(reason).into());
            }
            Some(account) => {
                let frame = account.frame;
                run.restore(account);
                run.complete = Some(frame);
                frame
            }
            // From a front end without frames. A part in a million does not make one.
            None => {
                let frame = (time * rate + 1e-6).floor();
                run.next_duration = Some(((frame + 1.0) / rate - time) as f32);
                frame as u32
            }
        };
        run.first = frame;
        Ok(run)
    }

    /// Everything that is needed to go on after the last [`Event::Frame`](super::Event::Frame); call it before
    /// asking for the next event.
    ///
    /// # Errors
    /// As [`Simulation::checkpoint`].
    pub fn checkpoint(&mut self) -> Result<Checkpoint, SimulationError> {
        let mut checkpoint = self.simulation.checkpoint(&self.scene_text)?;
        if let Some(foam) = &self.foam {
            checkpoint.set_foam(&block_on(self.simulation.keep_foam_async(foam))?);
        }
        // Within a frame there is no account of one.
        let between = !matches!(self.stage, Stage::Steps(_) | Stage::Fetch(_));
        let account = self.complete.filter(|_| between).map(|frame| Account {
            frame,
            density_error: self.density_error,
            volume: self.volume,
            particle_volume: self.particle_volume,
            watched: self.watched.clone(),
        });
        checkpoint.set(ACCOUNT, &account);
        Ok(checkpoint)
    }

    fn restore(&mut self, account: Account) {
        let Account { density_error, volume, particle_volume, watched, .. } = account;
        (self.density_error, self.volume, self.particle_volume) = (density_error, volume, particle_volume);
        self.watched = watched;
    }
}
