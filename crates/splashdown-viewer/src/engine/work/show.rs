//! Snapshots for the window, and meshes for export.

use std::sync::Arc;

use splashdown::SimulationError;
use splashdown::surface::SurfaceStats;

use super::Worker;
use crate::engine::{Message, Snapshot, lock};

impl Worker {
    /// Takes a snapshot.
    pub(super) async fn show(&mut self) -> Result<(), SimulationError> {
        let (Some(simulation), Some(opened)) = (&mut self.simulation, &mut self.opened) else {
            return Ok(());
        };
        let mut extracted: Option<SurfaceStats> = None;
        if self.wants_surface {
            if self.surface.is_none() {
                let settings = simulation.scene().surface.clone();
                self.surface = Some(simulation.surface(&settings)?);
            }
            if let Some(surface) = &mut self.surface {
                extracted = Some(simulation.extract_async(surface).await?);
            }
        }
        let mut foam = None;
        if simulation.scene().foam.enabled {
            if self.foam.is_none() {
                let settings = simulation.scene().foam;
                let mut new = simulation.foam(&settings)?;
                if let Some(saved) = self.saved_foam.take() {
                    simulation.restore_foam(&mut new, &saved)?;
                }
                self.foam = Some(new);
            }
            if let Some(current) = &mut self.foam {
                let count = simulation.foam_state_async(current).await?.count;
                foam = Some((&*current, count));
            }
        }
        let bodies = simulation.body_states_async().await?;
        let drawn = self.copies.take(simulation, self.surface.as_ref().zip(extracted), foam);
        let memory = simulation.memory();
        if opened.memory != memory {
            Arc::make_mut(opened).memory = memory;
        }
        let snapshot = Snapshot {
            opened: Arc::clone(opened),
            stats: simulation.stats(),
            drawn,
            bodies,
            mean_height: self.meter.mean_height,
            steps_per_second: self.meter.steps_per_second,
            speed: self.meter.speed,
            timings: Arc::clone(&self.meter.timings),
            timed_steps: self.meter.timed_steps,
            playing: self.playing,
        };
        let mut outbox = lock(&self.outbox);
        (outbox.snapshot, outbox.is_seen) = (Some(Arc::new(snapshot)), false);
        drop(outbox);
        (self.repaint)();
        Ok(())
    }

    pub(super) async fn export(&mut self) -> Result<(), SimulationError> {
        let Some(simulation) = &mut self.simulation else { return Ok(()) };
        if self.surface.is_none() {
            let settings = simulation.scene().surface.clone();
            self.surface = Some(simulation.surface(&settings)?);
        }
        let Some(surface) = &mut self.surface else { return Ok(()) };
        simulation.extract_async(surface).await?;
        let mesh = Arc::new(simulation.mesh_async(surface).await?);
        if !self.wants_surface {
            self.free_surface()?;
        }
        lock(&lock(&self.outbox).messages).push(Message::Exported(mesh));
        (self.repaint)();
        Ok(())
    }
}
