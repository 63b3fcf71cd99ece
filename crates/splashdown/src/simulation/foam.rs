//! Foam, spray and bubbles of a running simulation.

use splashdown_gpu::{Recording, block_on};

use super::Simulation;
use crate::SimulationError;
use crate::foam::{self, DiffuseParticles, Foam, FoamParams, FoamState, KeptFoam};
use crate::scene::{Derived, FoamSettings};

impl Simulation {
    /// Prepares foam, spray and bubbles with these settings; there are none yet. Whether they are enabled there
    /// does not matter.
    ///
    /// # Errors
    /// [`SimulationError::TooMany`], and those of the device.
    pub fn foam(&mut self, settings: &FoamSettings) -> Result<Foam, SimulationError> {
        let particles = self.params.particle_count;
        let capacity = foam::capacity(settings, particles.into(), self.executor.largest_buffer())?;
        let speed = Derived::without_particles(&self.scene).reference_speed;
        let constants = FoamParams::new(settings, &self.params, speed, capacity);
        let foam = Foam::new(&mut self.executor, &constants, &self.fields, &self.cells, particles)?;
        // So that time counts from now on.
        self.executor.run(foam.recording())?;
        Ok(foam)
    }

    /// Brings the foam up to the simulation's time; it does not wait for the device. Call it between two
    /// frames: it sorts the particles, as [`sort`](Self::sort). Called within a frame too, wherever
    /// [`continue_frame`](Self::continue_frame) returns, it takes finer steps: every 4 ms of simulated time, as
    /// far as batches of steps allow.
    ///
    /// # Errors
    /// Those of the device.
    pub fn advance_foam(&mut self, foam: &Foam) -> Result<(), SimulationError> {
        if self.frame.is_none() {
            self.sort()?;
        } else {
            // Within a frame the sorted arrays are those of the last step, whose ids went straight to the persistent ones.
            let mut ids = Recording::new("ids");
            ids.copy(self.fields.ids, self.fields.sorted_ids);
            self.executor.run(&ids)?;
        }
        Ok(self.executor.run(foam.recording())?)
    }

    /// All that is needed to go on with the foam later, in this simulation, in one that is resumed from a
    /// checkpoint, or in one that this was carried over to.
    ///
    /// # Errors
    /// Those of the device.
    pub async fn keep_foam_async(&mut self, foam: &Foam) -> Result<KeptFoam, SimulationError> {
        let state = self.executor.fetch(foam.state()).await?[0];
        let pool = self.executor.fetch_first(foam.pool(), state.count as usize).await?;
        Ok(KeptFoam { state, pool })
    }

    /// Goes on with foam that was kept at the time where the simulation is now. Where there is less room than
    /// there was, the youngest are left out.
    ///
    /// # Errors
    /// Those of the device.
    pub fn restore_foam(&mut self, foam: &mut Foam, kept: &KeptFoam) -> Result<(), SimulationError> {
        let count = kept.pool.len().min(foam.capacity() as usize);
        foam.remember(&kept.state);
        self.executor.write(foam.pool(), &kept.pool[..count])?;
        Ok(self.executor.write(foam.state(), &[FoamState { count: count as u32, ..kept.state }])?)
    }

    /// Diffuse particles there are, and what their last update did.
    ///
    /// # Errors
    /// Those of the device.
    pub async fn foam_state_async(&mut self, foam: &mut Foam) -> Result<FoamState, SimulationError> {
        let state = self.executor.fetch(foam.state()).await?[0];
        self.told.extend(foam.tell(&state));
        Ok(state)
    }

    /// Fetches the foam as it is now. Where there was no room for all, [`take_warnings`](Self::take_warnings)
    /// says so afterwards.
    ///
    /// # Errors
    /// Those of the device.
    pub fn diffuse(&mut self, foam: &mut Foam) -> Result<DiffuseParticles, SimulationError> {
        block_on(self.diffuse_async(foam))
    }

    /// [`diffuse`](Self::diffuse) where blocking is not possible, as on a web page.
    ///
    /// # Errors
    /// Those of the device.
    pub async fn diffuse_async(&mut self, foam: &mut Foam) -> Result<DiffuseParticles, SimulationError> {
        let state = self.foam_state_async(foam).await?;
        let pool = self.executor.fetch_first(foam.pool(), state.count as usize).await?;
        Ok(DiffuseParticles::new(&pool))
    }
}
