//! Results of a simulation: particles, bodies, the surface.

use glam::{Vec2, Vec4, Vec4Swizzles};
use splashdown_gpu::{Recording, block_on};
use splashdown_io::{Mesh, Particles};

use super::Simulation;
use crate::SimulationError;
use crate::bodies::BodyState;
use crate::scene::{Probe, Quantity, SurfaceSettings};
use crate::surface::{Surface, SurfaceInput, SurfaceParams, SurfaceStats};

impl Simulation {
    /// The active particles in the order of their ids. Densities and pressures are those at the beginning of the last
    /// step.
    ///
    /// # Errors
    /// Those of the device.
    pub fn particles(&mut self) -> Result<Particles, SimulationError> {
        block_on(self.particles_async())
    }

    /// [`particles`](Self::particles) where blocking is not possible, as on a web page.
    ///
    /// # Errors
    /// Those of the device.
    pub async fn particles_async(&mut self) -> Result<Particles, SimulationError> {
        let (fields, executor) = (self.fields, &mut self.executor);
        // All four copies are requested before the host waits for the first.
        let n = self.params.particle_count as usize;
        let positions = executor.request(fields.positions, n)?;
        let velocities = executor.request(fields.velocities, n)?;
        let densities = executor.request(fields.densities, n)?;
        let ids = executor.request(fields.ids, n)?.take().await?;
        let (positions, velocities) = (positions.take().await?, velocities.take().await?);
        let densities = densities.take().await?;
        Ok(in_order_of_id(&ids, &positions, &velocities, &densities))
    }

    /// The number of these particles that lie inside a body: zero in a sound run.
    ///
    /// # Errors
    /// Those of the device.
    pub fn inside_bodies(&mut self, particles: &Particles) -> Result<u32, SimulationError> {
        let Some(bodies) = &self.bodies else { return Ok(0) };
        let states = block_on(bodies.states(&mut self.executor))?;
        Ok(bodies.inside(&states, particles))
    }

    /// A warning for each gauge that is now so deep inside a body that no fluid reaches it.
    ///
    /// # Errors
    /// Those of the device.
    pub fn buried_probes(&mut self, probes: &[Probe]) -> Result<Vec<String>, SimulationError> {
        let Some(bodies) = &self.bodies else { return Ok(Vec::new()) };
        let states = block_on(bodies.states(&mut self.executor))?;
        let buried = probes.iter().filter_map(|probe| {
            let (Quantity::Pressure(x) | Quantity::Height(x)) = probe.quantity else { return None };
            let (distance, body) = bodies.nearest(&states, x)?;
            let depth = -1000.0 * distance;
            (distance < -self.params.particle_spacing).then(|| {
                format!(
                    "probe {:?} is {depth:.0} mm inside body {body:?} and measures nothing; move it to the surface",
                    probe.name
                )
            })
        });
        Ok(buried.collect())
    }

    /// The positions and velocities of the scene's bodies and the forces of the fluid on them, in the order of the
    /// scene.
    ///
    /// # Errors
    /// Those of the device.
    pub fn body_states(&mut self) -> Result<Vec<BodyState>, SimulationError> {
        block_on(self.body_states_async())
    }

    /// [`body_states`](Self::body_states) where blocking is not possible, as on a web page.
    ///
    /// # Errors
    /// Those of the device.
    pub async fn body_states_async(&mut self) -> Result<Vec<BodyState>, SimulationError> {
        match &self.bodies {
            Some(bodies) => Ok(bodies.states(&mut self.executor).await?),
            None => Ok(Vec::new()),
        }
    }

    /// Sorts the particles by cell without a step, as input for the surface. Call it between two frames: a frame in
    /// progress is abandoned.
    ///
    /// # Errors
    /// Those of the device.
    pub fn sort(&mut self) -> Result<(), SimulationError> {
        self.frame = None;
        let mut recording = Recording::new("sort");
        recording.append(&self.begin);
        self.cells.record_sort(&mut recording, &self.fields, self.fields.sorted_ids);
        self.executor.write(self.fields.duration, &[0.0])?;
        Ok(self.executor.run(&recording)?)
    }

    /// Creates a surface of the fluid with these settings.
    ///
    /// # Errors
    /// Those of the device.
    pub fn surface(&mut self, settings: &SurfaceSettings) -> Result<Surface, SimulationError> {
        let params = SurfaceParams::of_scene(settings, self.params.particle_spacing);
        let input = SurfaceInput {
            sorted_positions: self.fields.sorted_positions,
            cell_start: self.cells.cell_start,
            grid: self.cells.grid_uniform,
            grid_host: self.cells.grid,
            particle_capacity: self.params.particle_count,
        };
        Ok(Surface::new(&mut self.executor, params, input)?)
    }

    /// Extracts the surface of the particles; the mesh stays on the device. Call it between two frames, as
    /// [`sort`](Self::sort).
    ///
    /// # Errors
    /// Those of the device.
    pub fn extract(&mut self, surface: &mut Surface) -> Result<SurfaceStats, SimulationError> {
        block_on(self.extract_async(surface))
    }

    /// [`extract`](Self::extract) where blocking is not possible, as on a web page.
    ///
    /// # Errors
    /// Those of the device.
    pub async fn extract_async(&mut self, surface: &mut Surface) -> Result<SurfaceStats, SimulationError> {
        self.sort()?;
        Ok(surface.extract_async(&mut self.executor).await?)
    }

    /// Fetches the mesh of the last [`extract`](Self::extract).
    ///
    /// # Errors
    /// Those of the device.
    pub fn mesh(&mut self, surface: &Surface) -> Result<Mesh, SimulationError> {
        block_on(self.mesh_async(surface))
    }

    /// [`mesh`](Self::mesh) where blocking is not possible, as on a web page.
    ///
    /// # Errors
    /// Those of the device.
    pub async fn mesh_async(&mut self, surface: &Surface) -> Result<Mesh, SimulationError> {
        Ok(surface.mesh_async(&mut self.executor).await?)
    }
}

fn in_order_of_id(ids: &[u32], positions: &[Vec4], velocities: &[Vec4], densities: &[Vec2]) -> Particles {
    let mut order: Vec<u32> = (0..ids.len() as u32).filter(|&i| positions[i as usize].w == 0.0).collect();
    order.sort_unstable_by_key(|&i| ids[i as usize]);
    let order = || order.iter().map(|&i| i as usize);
    Particles::from_positions(order().map(|i| positions[i].xyz().to_array()).collect())
        .with_ids(order().map(|i| ids[i]).collect())
        .with_velocities(order().map(|i| velocities[i].xyz().to_array()).collect())
        .with_densities(order().map(|i| densities[i].x).collect())
        .with_pressures(order().map(|i| densities[i].y).collect())
}
