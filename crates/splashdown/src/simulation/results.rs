//! Results of a simulation: particles, bodies, the surface.

use splashdown_gpu::{GpuError, Recording, block_on};
use splashdown_io::{Mesh, ParticleInfo, Particles};

use super::Simulation;
use crate::bodies::{Bodies, BodyState};
use crate::monitor::{Findings, Monitor, Observed};
use crate::scene::{Probe, Quantity, SurfaceSettings};
use crate::state::{Carried, CarriedArrays, IDS, POSITIONS, StepState, Values};
use crate::surface::{Surface, SurfaceInput, SurfaceParams, SurfaceStats, Walls};
use crate::{SimulationError, Stats};

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
        let values = self.fetch_carried().await?;
        let find =
            |name: &str| values.iter().find(|(quantity, _)| quantity.name == name).map(|(_, v)| v.words());
        let (Some(ids), Some(positions)) = (find(IDS.name), find(POSITIONS.name)) else {
            unreachable!("the table has rows for ids and positions")
        };
        // The fourth component of a position marks removed particles.
        let is_active = |i: &u32| f32::from_bits(positions[4 * *i as usize + 3]) == 0.0;
        let mut order: Vec<u32> = (0..ids.len() as u32).filter(is_active).collect();
        order.sort_unstable_by_key(|&i| ids[i as usize]);
        let add = |particles, (quantity, values): &(&Carried, Values)| {
            (quantity.output)(particles, &values.ordered(quantity.kind, &order))
        };
        Ok(values.iter().fold(Particles::default().with_info(self.particle_info()), add))
    }

    /// Time and particle spacing, which files of particles contain.
    fn particle_info(&self) -> ParticleInfo {
        ParticleInfo::new(self.stats.time, self.params.particle_spacing)
    }

    /// The persistent arrays of all carried quantities. All copies are requested before the host waits for the first.
    pub(super) async fn fetch_carried(&mut self) -> Result<Vec<(&'static Carried, Values)>, SimulationError> {
        self.end_suspended_step()?;
        let (n, executor) = (self.params.particle_count as usize, &mut self.executor);
        let request = |arrays: &CarriedArrays| Ok((arrays.quantity, arrays.persistent.request(executor, n)?));
        let pending = self.fields.carried.iter().map(request).collect::<Result<Vec<_>, GpuError>>()?;
        let mut values = Vec::with_capacity(pending.len());
        for (quantity, copy) in pending {
            values.push((quantity, copy.take().await?));
        }
        Ok(values)
    }

    /// The number of these particles that lie inside a body. It is zero unless particles have leaked.
    ///
    /// # Errors
    /// Those of the device.
    pub fn inside_bodies(&mut self, particles: &Particles) -> Result<u32, SimulationError> {
        let Some(bodies) = &self.bodies else { return Ok(0) };
        let states = block_on(bodies.states(&mut self.executor))?;
        Ok(bodies.inside(&states, particles))
    }

    /// A monitor of this simulation from now on: examine every frame with it.
    pub fn monitor(&self) -> Monitor {
        Monitor::new(&self.scene, &self.params, self.body_meshes())
    }

    /// Examines the state at the end of a frame, whose particles, statistics and bodies are given.
    pub(crate) fn examine(
        &self,
        monitor: &mut Monitor,
        (time, stats): (f64, &Stats),
        particles: &Particles,
        bodies: &[BodyState],
    ) -> Findings {
        let of_bodies = self.bodies.as_ref().map(|all| all.nearest(bodies));
        let nearest = |x| of_bodies.as_ref().and_then(|nearest| nearest(x));
        monitor.observe(Observed { time, stats, particles, bodies, nearest: &nearest })
    }

    /// Reads the particles and bodies, and examines the state between two frames.
    ///
    /// # Errors
    /// Those of the device.
    pub async fn examine_async(&mut self, monitor: &mut Monitor) -> Result<Findings, SimulationError> {
        let particles = self.particles_async().await?;
        let bodies = self.body_states_async().await?;
        let inside_bodies = self.bodies.as_ref().map_or(0, |all| all.inside(&bodies, &particles));
        let stats = Stats { inside_bodies, ..self.stats };
        Ok(self.examine(monitor, (stats.time, &stats), &particles, &bodies))
    }

    /// A warning for each gauge that lies so deep inside a body that no fluid is within its reach.
    ///
    /// # Errors
    /// Those of the device.
    pub fn buried_probes(&mut self, probes: &[Probe]) -> Result<Vec<String>, SimulationError> {
        let Some(bodies) = &self.bodies else { return Ok(Vec::new()) };
        let states = block_on(bodies.states(&mut self.executor))?;
        let nearest = bodies.nearest(&states);
        let buried = probes.iter().filter_map(|probe| {
            let (Quantity::Pressure(x) | Quantity::Height(x)) = probe.quantity else { return None };
            let (distance, body) = nearest(x)?;
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
        self.end_suspended_step()?;
        self.frame = None;
        let mut recording = Recording::new("sort");
        recording.append(&self.begin);
        self.cells.record_sort(&mut recording, &self.fields, self.fields.sorted_ids);
        self.executor.write(self.fields.frame_input, &StepState::frame_input(0.0, self.stats.time, 0.0))?;
        Ok(self.executor.run(&recording)?)
    }

    /// Creates a surface of the fluid with these settings.
    ///
    /// # Errors
    /// Those of the device.
    pub fn surface(&mut self, settings: &SurfaceSettings) -> Result<Surface, SimulationError> {
        let params =
            SurfaceParams::of_scene(settings, self.params.particle_spacing, Walls::of_params(&self.params));
        let input = SurfaceInput {
            sorted_positions: self.fields.sorted_positions,
            sorted_velocities: self.fields.sorted_velocities,
            sorted_ids: self.fields.sorted_ids,
            cell_start: self.cells.cell_start,
            grid: self.cells.grid_uniform,
            grid_host: self.cells.grid,
            particle_capacity: self.params.particle_count,
            solids: self.bodies.as_ref().map(Bodies::solids),
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

    /// Fetches the isolated particles of the last [`extract`](Self::extract), which are not part of its mesh, in the order
    /// of their ids: ids, positions and velocities, and their diameter in m as the attribute `width`.
    ///
    /// # Errors
    /// Those of the device.
    pub fn droplets(&mut self, surface: &Surface) -> Result<Particles, SimulationError> {
        let droplets = block_on(surface.droplets_async(&mut self.executor))?;
        Ok(droplets.with_info(self.particle_info()))
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
