//! Foam, spray and bubbles of a running simulation.

use splashdown_gpu::{Recording, block_on};

use super::Simulation;
use crate::SimulationError;
use crate::bodies::Bodies;
use crate::foam::{self, DiffuseParticles, Foam, FoamParams, FoamState, KeptFoam};
use crate::scene::{Derived, FoamSettings};

impl Simulation {
    /// Creates foam, spray and bubbles with these settings, without particles. The setting `enabled` is ignored.
    ///
    /// # Errors
    /// [`SimulationError::TooMany`], and those of the device.
    pub fn foam(&mut self, settings: &FoamSettings) -> Result<Foam, SimulationError> {
        let particles = self.params.particle_count;
        let capacity = foam::capacity(settings, particles.into(), self.executor.largest_buffer())?;
        let speed = Derived::without_particles(&self.scene).reference_speed;
        let constants = FoamParams::new(settings, &self.params, speed, capacity);
        let solids = self.bodies.as_ref().map(Bodies::solids);
        let foam = Foam::new(&mut self.executor, &constants, &self.fields, &self.cells, solids, particles)?;
        // Sets the start of the first update's time step.
        self.executor.run(foam.recording())?;
        Ok(foam)
    }

    /// Advances the foam to the time of the simulation, without waiting for the device. Between two frames it
    /// sorts the particles, as [`sort`](Self::sort). Within a frame it may be called after each
    /// [`continue_frame`](Self::continue_frame), for finer steps of the foam: every 4 ms of simulated time, as far as
    /// the batches of steps allow.
    ///
    /// # Errors
    /// Those of the device.
    pub fn advance_foam(&mut self, foam: &Foam) -> Result<(), SimulationError> {
        if self.frame.is_none() {
            self.sort()?;
        } else {
            // Within a frame the sorted arrays are those of the last step, which wrote the ids to the persistent array.
            let mut ids = Recording::new("ids");
            ids.copy(self.fields.ids, self.fields.sorted_ids);
            self.executor.run(&ids)?;
        }
        Ok(self.executor.run(foam.recording())?)
    }

    /// Fetches the state of the foam, from which it can be restored later: in this simulation, in one resumed from a
    /// checkpoint, or in one made by [`rebuild_with`](Self::rebuild_with).
    ///
    /// # Errors
    /// Those of the device.
    pub async fn keep_foam_async(&mut self, foam: &Foam) -> Result<KeptFoam, SimulationError> {
        let state = self.executor.fetch(foam.state()).await?[0];
        let pool = self.executor.fetch_first(foam.pool(), state.count as usize).await?;
        Ok(KeptFoam { state, pool })
    }

    /// Restores foam that was saved at the present time of the simulation. If the capacity is smaller than it was, the
    /// youngest particles are dropped.
    ///
    /// # Errors
    /// Those of the device.
    pub fn restore_foam(&mut self, foam: &mut Foam, kept: &KeptFoam) -> Result<(), SimulationError> {
        let count = kept.pool.len().min(foam.capacity() as usize);
        foam.restore_overflow(&kept.state);
        self.executor.write(foam.pool(), &kept.pool[..count])?;
        Ok(self.executor.write(foam.state(), &[FoamState { count: count as u32, ..kept.state }])?)
    }

    /// The number of diffuse particles, and the counters of their last update.
    ///
    /// # Errors
    /// Those of the device.
    #[doc(hidden)]
    pub async fn foam_state_async(&mut self, foam: &mut Foam) -> Result<FoamState, SimulationError> {
        let state = self.executor.fetch(foam.state()).await?[0];
        self.warnings.extend(foam.overflow_warning(&state));
        Ok(state)
    }

    /// Fetches the diffuse particles. If the pool has overflowed, [`take_warnings`](Self::take_warnings)
    /// returns a warning afterwards.
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
