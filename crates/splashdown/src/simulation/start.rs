//! Construction of a simulation.

use std::mem::offset_of;

use glam::Vec3;
use rayon::prelude::*;
use splashdown_gpu::{Executor, Flag, block_on};
use splashdown_io::Particles;

use super::frame::{COLLISION_STEPS, IMPLICIT_COLLISION_STEPS, MOST_STEPS};
use super::phases::{HostAction, Phase, Schedule};
use super::{Simulation, packing};
use crate::bodies::{Bodies, LoadedBody};
use crate::cells::Cells;
use crate::check::Built;
use crate::flow::{Flow, LoadedFlow};
use crate::probes::Probes;
use crate::scene::{Derived, Scene};
use crate::schemes::{self, Couplings, Scheme};
use crate::solid;
use crate::state::{Carried, Fields, Initial, Params, StepState};
use crate::{Device, SimulationError, Stats, bodies, memory, sample, state};

impl Simulation {
    /// Creates a simulation of a scene on a device.
    ///
    /// # Errors
    /// Any [`SimulationError`] of devices, sampling and sizes.
    pub fn new(scene: &Scene, device: &Device) -> Result<Self, SimulationError> {
        Self::with_executor(scene, device.executor()?)
    }

    /// Creates a simulation of a scene on an open executor.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_executor(scene: &Scene, executor: Executor) -> Result<Self, SimulationError> {
        Self::prepare(scene, executor, &|_, _| {})
    }

    /// As [`with_executor`](Self::with_executor). `progress` is called with what is being prepared and the completed part in
    /// [0, 1]: the distance field of each body, which takes seconds for a mesh of 100,000 triangles the first time, and the
    /// initial packing of particles that are too close.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn prepare(
        scene: &Scene,
        executor: Executor,
        progress: &(dyn Fn(&str, f32) + Sync),
    ) -> Result<Self, SimulationError> {
        block_on(Self::prepare_async(scene, executor, progress))
    }

    /// [`prepare`](Self::prepare) where blocking is not possible, as on a web page.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub async fn prepare_async(
        scene: &Scene,
        executor: Executor,
        progress: &(dyn Fn(&str, f32) + Sync),
    ) -> Result<Self, SimulationError> {
        let bodies = Self::load_bodies(scene, progress)?;
        let mut particles = Built::of(scene).take_particles(scene)?;
        let removed = sample::remove_inside(scene, &mut particles, &bodies);
        Built::of(scene).flow(scene)?.fill_nozzles(&mut particles, scene);
        let packing = packing::relax(scene, &mut particles, &bodies, packing::MAX_ROUNDS, progress)?;
        sample::start_at_rest(scene, &mut particles, &bodies);
        if removed > 0 && particles.positions.is_empty() {
            return Err(sample::SampleError::AllInside { removed }.into());
        }
        let mut simulation =
            Self::with_bodies(scene, executor, &particles, bodies, Scheme::new(scene).carried()).await?;
        simulation.removed = removed;
        simulation.packing = packing;
        Ok(simulation)
    }

    /// Starts from these particles instead of the scene's blocks. Of the quantities besides positions, each has one value
    /// per particle or none: velocities in m/s (else zero), ids (unique; else the indices), densities in kg/m^3, the initial
    /// values of the continuity equation, and pressures in Pa, with which the iterations of `dfsph` begin. Particles that
    /// lie outside the domain, are not finite, or have a density that is not positive are removed and counted.
    ///
    /// # Errors
    /// [`SimulationError::Count`] and [`SimulationError::DuplicateId`]; otherwise as [`new`](Self::new).
    pub fn with_particles(
        scene: &Scene,
        executor: Executor,
        particles: &Particles,
    ) -> Result<Self, SimulationError> {
        check_particles(particles)?;
        let bodies = Self::load_bodies(scene, &|_, _| {})?;
        block_on(Self::with_bodies(scene, executor, particles, bodies, Scheme::new(scene).carried()))
    }

    pub(crate) fn load_bodies(
        scene: &Scene,
        progress: &(dyn Fn(&str, f32) + Sync),
    ) -> Result<Vec<LoadedBody>, SimulationError> {
        let kernels = Scheme::new(scene).walls();
        let params = schemes::params(scene, 0);
        let meshes = Built::of(scene).take_meshes(scene);
        Ok(bodies::load(scene, meshes, &params, kernels, solid::default_cache_folder(), progress)?)
    }

    pub(super) async fn with_bodies(
        scene: &Scene,
        executor: Executor,
        particles: &Particles,
        loaded: Vec<LoadedBody>,
        table: &'static [Carried],
    ) -> Result<Self, SimulationError> {
        let n = particles.positions.len();
        let largest = executor.largest_buffer();
        memory::check_particles(n as u64, largest, scene)?;
        let loaded_flow = Built::of(scene).flow(scene)?;
        // Particles that are not yet emitted follow the initial ones.
        let initial = n as u32;
        let capacity =
            loaded_flow.capacity(n as u64, memory::largest_particle_count_of(scene, largest)) as u32;
        let next_id = particles.ids.iter().max().map_or(initial, |&id| id.saturating_add(1));
        let mut simulation = Self::assemble(scene, executor, capacity, next_id, loaded, &loaded_flow, table)?;
        simulation.initial = initial;
        upload(&mut simulation.executor, &simulation.fields, particles, &simulation.params)?;
        simulation.executor.write(simulation.fields.frame_input, &StepState::frame_input(0.0, 0.0, 0.0))?;
        simulation.executor.run(&simulation.prime)?;
        simulation.count().await?;
        // The estimate of the scene does not know the velocities and densities of particles from files and programs.
        let fastest = particles.velocities.iter().map(|&v| Vec3::from(v).length()).fold(0.0, f32::max);
        let densest = particles.densities.iter().copied().fold(0.0, f32::max);
        let excess = (densest / simulation.params.rest_density - 1.0).max(0.0);
        if fastest > 0.0 || excess > 0.0 {
            simulation.limit_time_step(fastest, excess).await?;
        }
        Ok(simulation)
    }

    /// Creates the buffers and records the step, for at most `capacity` particles; does not write the particles.
    pub(super) fn assemble(
        scene: &Scene,
        mut executor: Executor,
        capacity: u32,
        next_id: u32,
        loaded: Vec<LoadedBody>,
        loaded_flow: &LoadedFlow,
        table: &'static [Carried],
    ) -> Result<Self, SimulationError> {
        let scheme = Scheme::new(scene);
        let params = bodies::limit_step(schemes::params(scene, capacity), &loaded);
        let grid = memory::grid_of(scene).ok_or_else(|| SimulationError::TooMany {
            what: "grid cells",
            given: u64::MAX,
            allowed: (1 << 31) - 1,
            advice: "make the domain smaller or particle_spacing larger".into(),
        })?;
        let grid = match executor.gpu() {
            Some(gpu) => grid.for_gpu(capacity, gpu.largest_buffer()),
            None => grid,
        };
        let fields = Fields::with_table(&mut executor, &params, scheme.extras(!loaded.is_empty()), table)?;
        let cells = Cells::new(&mut executor, grid, capacity, scene.solver.sort.into())?;
        let bodies = if loaded.is_empty() {
            None
        } else {
            Some(Bodies::new(&mut executor, loaded, &params, scheme.walls(), &scene.domain)?)
        };
        let flow =
            if loaded_flow.is_empty() { None } else { Some(Flow::new(&mut executor, loaded_flow, next_id)?) };
        let stable_dt = Derived::without_particles(scene).dt_estimate.min(params.max_dt).max(params.min_dt);
        let first = StepState { stable_dt, dt: stable_dt, ..bytemuck::Zeroable::zeroed() };
        executor.write(fields.state, &[first])?;

        let probes = Probes::new(&mut executor, scene, bodies.as_ref())?;
        Built::of(scene).release();
        let mut simulation = Self {
            begin: schemes::begin_frame(&cells, &fields),
            prime: scheme.initial_state(
                &cells,
                &fields,
                &Couplings { bodies: bodies.as_ref(), ..Couplings::default() },
                capacity,
            ),
            executor,
            scene: scene.clone(),
            params,
            fields,
            cells,
            schedule: Schedule::empty(),
            solver_rounds: scheme.solver_rounds(),
            end_suspended: None,
            may_be_suspended: false,
            stats: Stats::default(),
            stable_dt,
            frame: None,
            bodies,
            removed: 0,
            packing: None,
            flow,
            rows: vec![Vec::new(); scene.probes.len()],
            probes,
            mouse_force: None,
            most_steps: MOST_STEPS,
            initial: 0,
            warnings: Vec::new(),
        };
        simulation.record_step()?;
        Ok(simulation)
    }

    /// Records the step of the scene with the present couplings.
    ///
    /// # Errors
    /// As [`Executor::create`].
    pub(super) fn record_step(&mut self) -> Result<(), SimulationError> {
        let scheme = Scheme::new(&self.scene);
        let couplings = Couplings {
            bodies: self.bodies.as_ref(),
            flow: self.flow.as_ref(),
            probes: self.probes.as_ref(),
            mouse_force: self.mouse_force.as_ref(),
        };
        if !(scheme.is_fused() && couplings.is_empty()) {
            self.fields.make_accelerations(&mut self.executor)?;
        }
        self.solver_rounds = scheme.solver_rounds();
        let count = self.params.particle_count;
        let step = scheme.step(&self.cells, &self.fields, &couplings, count, &self.solver_rounds);
        // A GPU cannot end the iterations of a submission when a solver has stopped.
        let can_suspend = scheme.is_implicit() && self.executor.gpu().is_some() && self.cells.can_pause();
        self.end_suspended = can_suspend.then(|| {
            let whole = scheme.step(&self.cells, &self.fields, &couplings, count, &scheme.solver_rounds());
            schemes::end_suspended_step(&whole, &self.cells, &self.fields)
        });
        let mut phases = vec![Phase::Device(step)];
        if self.bodies.as_ref().is_some_and(Bodies::collide) {
            let steps = if scheme.is_implicit() { IMPLICIT_COLLISION_STEPS } else { COLLISION_STEPS };
            phases.push(Phase::Host { action: HostAction::ResolveCollisions, steps });
        }
        let end_step = state::end_step::record(&self.fields);
        let done = Flag::new(self.fields.state, offset_of!(StepState, done)).except(schemes::REPEATABLE);
        self.schedule = Schedule::new(phases, &end_step, done, MOST_STEPS);
        Ok(())
    }
}

/// Checks the numbers of values and the ids of particles from a program.
fn check_particles(particles: &Particles) -> Result<(), SimulationError> {
    let expected = particles.positions.len();
    let counts = [
        ("velocities", particles.velocities.len()),
        ("densities", particles.densities.len()),
        ("pressures", particles.pressures.len()),
        ("ids", particles.ids.len()),
    ];
    if let Some((what, given)) = counts.into_iter().find(|&(_, given)| given != 0 && given != expected) {
        return Err(SimulationError::Count { what, given, expected });
    }
    let mut ids = particles.ids.clone();
    ids.par_sort_unstable();
    match ids.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => Err(SimulationError::DuplicateId { id: pair[0] }),
        None => Ok(()),
    }
}

/// Writes the initial values of the carried quantities.
fn upload(
    executor: &mut Executor,
    fields: &Fields,
    particles: &Particles,
    params: &Params,
) -> Result<(), SimulationError> {
    let start = Initial { particles, params };
    for arrays in &fields.carried {
        if let Some(words) = arrays.initial(&start, params.particle_count as usize) {
            arrays.persistent.write(executor, &words)?;
        }
    }
    Ok(())
}
