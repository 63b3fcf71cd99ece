//! A running simulation.

use std::mem::offset_of;
use std::sync::Arc;

use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};
use splashdown_gpu::{Executor, Flag, Gpu, Readback, Recording, Timings};
use splashdown_io::{Mesh, Particles};

use crate::bodies::{Bodies, BodyMesh, BodyState, LoadedBody};
use crate::cells::{Cells, Grid};
use crate::fields::Fields;
use crate::flow::{Flow, LoadedFlow};
use crate::passes::{DEAD_NON_FINITE, DEAD_UNBORN, Params, StepState, Tally};
use crate::probes::{ProbeRows, Probes};
use crate::scene::{Derived, Probe, Quantity, Scene, SurfaceSettings};
use crate::solid::{self, RepairReport};
use crate::solver::{self, Solver};
use crate::surface::{Surface, SurfaceInput, SurfaceParams, SurfaceStats};
use crate::{Device, SimulationError, Stats, bodies, memory, sample};

/// Most steps in one submission to a device: a bound on how long it does not answer.
const MOST_STEPS: u32 = 64;
/// Steps in one batch on the CPU, which tests for the frame's end before each.
const CPU_STEPS: u32 = 16;

/// A fluid in its box, with everything that moves it, on one device.
///
/// ```
/// use splashdown::{Device, Simulation, scene::Scene};
/// # let text = include_str!("../../../scenes/dam-break-small.toml");
/// let scene = Scene::parse(text, "dam-break-small.toml")?;
/// let mut simulation = Simulation::new(&scene, &Device::Cpu)?;
/// let stats = simulation.advance(0.001)?;
/// assert!(stats.steps > 0 && stats.escaped == 0);
/// let particles = simulation.particles()?;
/// assert_eq!(particles.positions.len(), stats.particles as usize);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Simulation {
    executor: Executor,
    params: Params,
    fields: Fields,
    cells: Cells,
    begin: Recording,
    prime: Recording,
    /// The step, repeated 1, 2, 4, ... times.
    batches: Vec<Recording>,
    stats: Stats,
    /// What `stable_dt` was when last heard of, in seconds.
    stable_dt: f32,
    frame: Option<FrameInProgress>,
    bodies: Option<Bodies>,
    removed: u32,
    flow: Option<Flow>,
    probes: Option<Probes>,
    /// Rows of the probes since they were last asked for.
    rows: Vec<ProbeRows>,
    /// Particles at the start.
    initial: u32,
    /// What the emitters had to tell since it was last asked for.
    told: Vec<String>,
}

/// A frame that has begun.
struct FrameInProgress {
    duration: f32,
    /// Steps submitted so far.
    submitted: u32,
    /// The state behind the batch before the last: the device always has work while the host looks.
    pending: Option<Readback<StepState>>,
    state: Option<StepState>,
}

impl Simulation {
    /// Places a scene's particles on a device.
    ///
    /// # Errors
    /// Any [`SimulationError`] of devices, sampling and sizes.
    pub fn new(scene: &Scene, device: &Device) -> Result<Self, SimulationError> {
        Self::with_executor(scene, device.executor()?)
    }

    /// Places a scene's particles on an executor that is already there.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_executor(scene: &Scene, executor: Executor) -> Result<Self, SimulationError> {
        Self::prepare(scene, executor, &|_, _| {})
    }

    /// As [`with_executor`](Self::with_executor); `told` hears of each body whose distances are being computed, its name
    /// and how far it is, in [0, 1]: a mesh of a hundred thousand triangles takes seconds when it is first seen.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn prepare(
        scene: &Scene,
        executor: Executor,
        told: &(dyn Fn(&str, f32) + Sync),
    ) -> Result<Self, SimulationError> {
        let bodies = Self::load_bodies(scene, told)?;
        let mut particles = sample::particles(scene)?;
        let removed = sample::remove_inside(scene, &mut particles, &bodies);
        if removed > 0 && particles.positions.is_empty() {
            return Err(sample::SampleError::AllInside { removed }.into());
        }
        let mut simulation = Self::with_bodies(scene, executor, &particles, bodies)?;
        simulation.removed = removed;
        Ok(simulation)
    }

    /// Starts from these particles instead of the scene's blocks. `ids`, if given, must be different from each other;
    /// `densities`, if given, are where the continuity equation starts, in kg/m^3. Particles that lie outside the domain,
    /// are not finite, or have a density that is not positive are taken out and counted.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_particles(
        scene: &Scene,
        executor: Executor,
        particles: &Particles,
    ) -> Result<Self, SimulationError> {
        Self::with_bodies(scene, executor, particles, Self::load_bodies(scene, &|_, _| {})?)
    }

    pub(crate) fn load_bodies(
        scene: &Scene,
        told: &(dyn Fn(&str, f32) + Sync),
    ) -> Result<Vec<LoadedBody>, SimulationError> {
        let kernels = Solver::new(scene).walls();
        let params = solver::params(scene, 0);
        Ok(bodies::load(scene, &params, kernels, solid::default_cache_folder(), told)?)
    }

    fn with_bodies(
        scene: &Scene,
        mut executor: Executor,
        particles: &Particles,
        loaded: Vec<LoadedBody>,
    ) -> Result<Self, SimulationError> {
        let n = particles.positions.len();
        let largest = executor.largest_buffer();
        memory::check(n as u64, largest)?;
        let solver = Solver::new(scene);
        let loaded_flow = LoadedFlow::new(scene)?;
        // The unborn have places of their own.
        let (initial, n) =
            (n as u32, loaded_flow.capacity(n as u64, memory::largest_particle_count(largest)) as usize);
        let params = solver::params(scene, n as u32);
        let (min, max) = (scene.domain.min, scene.domain.max);
        let grid =
            Grid::new(min, max, memory::grid_reach(scene)).ok_or_else(|| SimulationError::TooMany {
                what: "grid cells",
                given: u64::MAX,
                allowed: 1 << 31,
                advice: "make the domain smaller or particle_spacing larger".into(),
            })?;
        let fields = Fields::new(&mut executor, &params, solver.walls(), solver.needs_normals())?;
        let cells = Cells::new(&mut executor, grid, n as u32, scene.solver.sort)?;
        let bodies = if loaded.is_empty() {
            None
        } else {
            Some(Bodies::new(&mut executor, loaded, &params, solver.walls(), &scene.domain)?)
        };
        let flow = if loaded_flow.is_empty() {
            None
        } else {
            let next_id = particles.ids.iter().max().map_or(initial, |&id| id.saturating_add(1));
            Some(Flow::new(&mut executor, &loaded_flow, params.particle_spacing, next_id)?)
        };
        upload(&mut executor, &fields, particles, &params)?;
        let stable_dt = Derived::without_particles(scene).dt_estimate.clamp(params.min_dt, params.max_dt);
        let first = StepState { stable_dt, dt: stable_dt, ..bytemuck::Zeroable::zeroed() };
        executor.write(fields.state, &[first])?;

        let probes = Probes::new(&mut executor, scene, bodies.as_ref())?;
        let step = solver.step(&cells, &fields, bodies.as_ref(), flow.as_ref(), probes.as_ref(), n as u32);
        let done = Flag::new(fields.state, offset_of!(StepState, done));
        let batches = (0..=MOST_STEPS.ilog2())
            .map(|power| {
                let mut batch = Recording::new(format!("{} steps", 1 << power));
                batch.repeat(&step, 1 << power, done);
                batch
            })
            .collect();
        let mut simulation = Self {
            begin: solver::begin_frame(&fields),
            prime: solver.prime(&cells, &fields, bodies.as_ref(), n as u32),
            executor,
            params,
            fields,
            cells,
            batches,
            stats: Stats::default(),
            stable_dt,
            frame: None,
            bodies,
            removed: 0,
            flow,
            rows: vec![Vec::new(); scene.probes.len()],
            probes,
            initial,
            told: Vec::new(),
        };
        simulation.executor.write(simulation.fields.duration, &[0.0])?;
        simulation.executor.run(&simulation.prime)?;
        simulation.count()?;
        Ok(simulation)
    }

    /// Simulates `seconds`, in as many steps as stability asks for, and waits for the end.
    ///
    /// # Errors
    /// [`SimulationError::BadDuration`], [`SimulationError::StepTooSmall`], [`SimulationError::NothingLeft`], and those of
    /// the device.
    pub fn advance(&mut self, seconds: f32) -> Result<Stats, SimulationError> {
        self.begin(seconds)?;
        loop {
            if let Some(stats) = self.continue_frame()? {
                return Ok(stats);
            }
        }
    }

    /// Begins a frame of this many seconds; [`continue_frame`](Self::continue_frame) works on it. A frame of no length is
    /// complete at once, without a step.
    ///
    /// # Errors
    /// [`SimulationError::BadDuration`] if that is not a length of time, and those of the device.
    pub fn begin(&mut self, seconds: f32) -> Result<(), SimulationError> {
        if !(seconds >= 0.0 && seconds.is_finite()) {
            return Err(SimulationError::BadDuration { seconds });
        }
        if seconds == 0.0 {
            self.frame = None;
            self.stats.steps_in_frame = 0;
            return Ok(());
        }
        if let Some(bodies) = &self.bodies {
            bodies.begin_frame(&mut self.executor, self.stats.time, f64::from(seconds))?;
        }
        self.executor.write(self.fields.duration, &[seconds])?;
        self.executor.run(&self.begin)?;
        self.frame = Some(FrameInProgress { duration: seconds, submitted: 0, pending: None, state: None });
        Ok(())
    }

    /// Submits the next steps of the frame, without waiting for them; the frame's account once it is complete, `None`
    /// before.
    ///
    /// # Errors
    /// As [`advance`](Self::advance).
    pub fn continue_frame(&mut self) -> Result<Option<Stats>, SimulationError> {
        let Some(mut frame) = self.frame.take() else { return Ok(Some(self.stats)) };
        // What is known is one batch old, or nothing yet; one step more meets the frame's end.
        let (steps, remaining) =
            frame.state.map_or((0, frame.duration), |state| (state.steps, state.remaining));
        let to_come = (remaining / self.stable_dt).ceil() as u32;
        let expected = steps.saturating_add(to_come).saturating_add(1);
        let collide = self.bodies.as_ref().is_some_and(Bodies::collide);
        let most = if self.executor.gpu().is_some() && !collide { MOST_STEPS } else { CPU_STEPS };
        let left = expected.saturating_sub(frame.submitted).clamp(1, most);
        let power = left.ilog2();
        self.executor.run(&self.batches[power as usize])?;
        frame.submitted += 1 << power;
        let behind = frame.pending.replace(self.executor.request(self.fields.state, 1)?);
        // Once all expected steps are submitted there is nothing left to overlap with; on the CPU there never is. Bodies that
        // may collide are looked at before they go on.
        let answer = if frame.submitted >= expected || self.executor.gpu().is_none() || collide {
            frame.pending.take()
        } else {
            behind
        };
        if let Some(readback) = answer {
            let state = readback.wait(&mut self.executor)?[0];
            self.stable_dt = state.stable_dt;
            if let Some(bodies) = &mut self.bodies
                && collide
            {
                let passed = remaining - state.remaining;
                bodies.resolve_collisions(&mut self.executor, passed)?;
            }
            frame.state = Some(state);
            // A step too small for the scene would take for ever to reach the frame's end.
            if state.done != 0 || state.too_small != 0 {
                return self.end_frame(state).map(Some);
            }
        }
        self.frame = Some(frame);
        Ok(None)
    }

    fn end_frame(&mut self, state: StepState) -> Result<Stats, SimulationError> {
        let last = self.stats;
        let passed =
            if state.done != 0 { state.frame_duration } else { state.frame_duration - state.remaining };
        if let Some(probes) = &self.probes {
            let taken = probes.take(&mut self.executor, last.time, passed)?;
            for (rows, more) in self.rows.iter_mut().zip(taken) {
                rows.extend(more);
            }
        }
        self.stats = Stats {
            time: last.time + f64::from(passed),
            steps: last.steps + u64::from(state.steps),
            steps_in_frame: state.steps,
            dt: state.stable_dt,
            density_error: state.density_error,
            max_speed: state.max_speed,
            ..last
        };
        self.count()?;
        if state.too_small != 0 {
            return Err(SimulationError::StepTooSmall {
                time: self.stats.time,
                min_dt: self.params.min_dt,
                max_speed: state.max_speed,
                max_acceleration: state.max_acceleration,
            });
        }
        if self.stats.particles == 0 && self.initial > 0 && self.flow.is_none() {
            return Err(SimulationError::NothingLeft {
                time: self.stats.time,
                reason: format!(
                    "{} left through open sides, {} were not finite",
                    self.stats.escaped, self.stats.non_finite
                ),
            });
        }
        Ok(self.stats)
    }

    /// Brings the counters of lost particles up to date.
    fn count(&mut self) -> Result<(), SimulationError> {
        let tally = self.executor.read(self.fields.tally)?;
        let stats = &mut self.stats;
        stats.escaped = tally[Tally::ESCAPED];
        stats.wall_corrections = tally[Tally::CORRECTIONS];
        stats.speed_limits = tally[Tally::LIMITED];
        stats.drained = tally[Tally::DRAINED];
        if let Some(flow) = &mut self.flow {
            let (count, told) = flow.count(&mut self.executor)?;
            (stats.emitted, stats.refused) = (count.emitted, count.refused);
            self.told.extend(told);
        }
        let gone = stats.escaped + stats.drained + tally[Tally::NON_FINITE];
        stats.particles = self.initial + stats.emitted - gone;
        if tally[Tally::NON_FINITE] > stats.non_finite {
            stats.non_finite = tally[Tally::NON_FINITE];
            let (positions, ids) =
                (self.executor.read(self.fields.positions)?, self.executor.read(self.fields.ids)?);
            let dead = positions.iter().zip(ids).filter(|(p, _)| p.w == DEAD_NON_FINITE);
            if let Some((p, id)) = dead.min_by_key(|(_, id)| *id) {
                stats.non_finite_place = p.xyz().to_array();
                stats.non_finite_id = id;
            }
        }
        Ok(())
    }

    /// The account of the last frame.
    pub fn stats(&self) -> Stats {
        self.stats
    }

    /// Simulated time in seconds and steps, those of the frame in progress included as far as they are known.
    pub fn progress(&self) -> (f64, u64) {
        let known = self.frame.as_ref().and_then(|frame| frame.state);
        known.map_or((self.stats.time, self.stats.steps), |state| {
            let done = f64::from(state.frame_duration - state.remaining);
            (self.stats.time + done, self.stats.steps + u64::from(state.steps))
        })
    }

    /// The time step in seconds that stability asked for when last heard of.
    pub fn dt(&self) -> f32 {
        self.stable_dt
    }

    /// The living particles in order of id. Densities and pressures are those of the last step's beginning.
    ///
    /// # Errors
    /// Those of the device.
    pub fn particles(&mut self) -> Result<Particles, SimulationError> {
        let (fields, executor) = (self.fields, &mut self.executor);
        // All four travel together; only then does the host wait.
        let n = self.params.particle_count as usize;
        let positions = executor.request(fields.positions, n)?;
        let velocities = executor.request(fields.velocities, n)?;
        let densities = executor.request(fields.densities, n)?;
        let ids = executor.request(fields.ids, n)?.wait(executor)?;
        let (positions, velocities) = (positions.wait(executor)?, velocities.wait(executor)?);
        let densities = densities.wait(executor)?;
        Ok(in_order_of_id(&ids, &positions, &velocities, &densities))
    }

    /// What emitters had to tell since the last call: each says once when it found no room.
    pub fn take_warnings(&mut self) -> Vec<String> {
        std::mem::take(&mut self.told)
    }

    /// What the scene's probes have measured in whole frames since the last call: rows of each, in the scene's order.
    pub fn take_probe_rows(&mut self) -> Vec<ProbeRows> {
        self.rows.iter_mut().map(std::mem::take).collect()
    }

    /// The meshes of the scene's bodies, in its order.
    pub fn body_meshes(&self) -> &[BodyMesh] {
        self.bodies.as_ref().map_or(&[], Bodies::meshes)
    }

    /// How many particles of the scene were left out because they would have been inside a body.
    pub fn removed(&self) -> u32 {
        self.removed
    }

    /// What was found in the meshes of the scene's bodies and done about it, in its order.
    pub fn body_reports(&self) -> &[RepairReport] {
        self.bodies.as_ref().map_or(&[], Bodies::reports)
    }

    /// How many of these particles lie inside a body: zero in a sound run.
    ///
    /// # Errors
    /// Those of the device.
    pub fn inside_bodies(&mut self, particles: &Particles) -> Result<u32, SimulationError> {
        let Some(bodies) = &self.bodies else { return Ok(0) };
        let states = bodies.states(&mut self.executor)?;
        Ok(bodies.inside(&states, particles))
    }

    /// A sentence for each gauge that is so deep inside a body that no fluid is near it, as things are now.
    ///
    /// # Errors
    /// Those of the device.
    pub fn buried_probes(&mut self, probes: &[Probe]) -> Result<Vec<String>, SimulationError> {
        let Some(bodies) = &self.bodies else { return Ok(Vec::new()) };
        let states = bodies.states(&mut self.executor)?;
        let buried = probes.iter().filter_map(|probe| {
            let (Quantity::Pressure(x) | Quantity::Height(x)) = probe.quantity else { return None };
            let (distance, body) = bodies.nearest(&states, x)?;
            let depth = -1000.0 * distance;
            (distance < -self.params.particle_spacing).then(|| {
                format!(
                    "probe {:?} is {depth:.0} mm inside body {body:?}, where it measures nothing; move it to the surface",
                    probe.name
                )
            })
        });
        Ok(buried.collect())
    }

    /// Where the scene's bodies are and what the fluid does to them, in its order.
    ///
    /// # Errors
    /// Those of the device.
    pub fn body_states(&mut self) -> Result<Vec<BodyState>, SimulationError> {
        match &self.bodies {
            Some(bodies) => Ok(bodies.states(&mut self.executor)?),
            None => Ok(Vec::new()),
        }
    }

    /// Sorts the particles as they are now by cell, without a step: input of the surface. For between two frames: one
    /// that has begun and is not complete is given up.
    ///
    /// # Errors
    /// Those of the device.
    pub fn sort(&mut self) -> Result<(), SimulationError> {
        self.frame = None;
        let mut recording = Recording::new("sort");
        recording.append(&self.begin);
        self.cells.record(&mut recording, &self.fields);
        self.executor.write(self.fields.duration, &[0.0])?;
        Ok(self.executor.run(&recording)?)
    }

    /// Prepares the fluid's surface with the scene's settings.
    ///
    /// # Errors
    /// Those of the device.
    pub fn surface(&mut self, settings: &SurfaceSettings) -> Result<Surface, SimulationError> {
        let params = SurfaceParams::of_scene(settings, self.params.particle_spacing);
        let input = SurfaceInput {
            positions: self.fields.sorted_positions,
            cell_start: self.cells.cell_start,
            grid: self.cells.grid_uniform,
            grid_host: self.cells.grid,
            particle_capacity: self.params.particle_count,
        };
        Ok(Surface::new(&mut self.executor, params, input)?)
    }

    /// Extracts the surface of the particles as they are now; it stays on the device. For between two frames, as
    /// [`sort`](Self::sort).
    ///
    /// # Errors
    /// Those of the device.
    pub fn extract(&mut self, surface: &mut Surface) -> Result<SurfaceStats, SimulationError> {
        self.sort()?;
        Ok(surface.extract(&mut self.executor)?)
    }

    /// Fetches the surface extracted last.
    ///
    /// # Errors
    /// Those of the device.
    pub fn mesh(&mut self, surface: &Surface) -> Result<Mesh, SimulationError> {
        Ok(surface.mesh(&mut self.executor)?)
    }

    /// The constants of the simulation.
    pub fn params(&self) -> &Params {
        &self.params
    }

    /// Its buffers, for drawing straight from them.
    pub fn fields(&self) -> &Fields {
        &self.fields
    }

    /// The grid and the sorted order.
    pub fn cells(&self) -> &Cells {
        &self.cells
    }

    /// Where it runs.
    pub fn executor(&mut self) -> &mut Executor {
        &mut self.executor
    }

    /// The device, if this does not run on the CPU.
    pub fn gpu(&self) -> Option<&Arc<Gpu>> {
        self.executor.gpu()
    }

    /// The device's name.
    pub fn device_name(&self) -> String {
        match self.executor.gpu() {
            Some(gpu) => gpu.name(),
            None => format!("CPU ({} threads)", rayon::current_num_threads()),
        }
    }

    /// Bytes in buffers.
    pub fn memory(&self) -> u64 {
        self.executor.bytes()
    }

    /// From now on every pass is timed; false where the device cannot.
    pub fn enable_timing(&mut self) -> bool {
        self.executor.enable_timing()
    }

    /// Time per pass since the last call.
    pub fn take_timings(&mut self) -> Timings {
        self.executor.take_timings()
    }
}

fn upload(
    executor: &mut Executor,
    fields: &Fields,
    particles: &Particles,
    params: &Params,
) -> Result<(), SimulationError> {
    let n = particles.positions.len();
    let unborn = params.particle_count as usize - n;
    let rest_density = params.rest_density;
    let mut positions: Vec<Vec4> = particles.positions.iter().map(|&x| Vec3::from(x).extend(0.0)).collect();
    positions.extend(vec![params.domain_min.extend(DEAD_UNBORN); unborn]);
    // Passes divide by densities: one that is not positive is as good as none, and its particle is taken out as such.
    let positive = |rho: f32| if rho > 0.0 { rho } else { f32::NAN };
    let density = |i: usize| particles.densities.get(i).map_or(rest_density, |&rho| positive(rho));
    let velocity = |i: usize| Vec3::from(particles.velocities.get(i).copied().unwrap_or_default());
    let mut velocities: Vec<Vec4> = (0..n).map(|i| velocity(i).extend(density(i))).collect();
    velocities.extend(vec![Vec3::ZERO.extend(rest_density); unborn]);
    let mut ids: Vec<u32> =
        if particles.ids.len() == n { particles.ids.clone() } else { (0..n as u32).collect() };
    // Ids of the unborn must differ from each other and from those of the dead: they count down from the largest.
    ids.extend((0..unborn as u32).map(|k| u32::MAX - k));
    executor.write(fields.positions, &positions)?;
    executor.write(fields.velocities, &velocities)?;
    executor.write(fields.ids, &ids)?;
    Ok(())
}

fn in_order_of_id(ids: &[u32], positions: &[Vec4], velocities: &[Vec4], densities: &[Vec2]) -> Particles {
    let mut order: Vec<u32> = (0..ids.len() as u32).filter(|&i| positions[i as usize].w == 0.0).collect();
    order.sort_unstable_by_key(|&i| ids[i as usize]);
    let order = || order.iter().map(|&i| i as usize);
    Particles {
        ids: order().map(|i| ids[i]).collect(),
        positions: order().map(|i| positions[i].xyz().to_array()).collect(),
        velocities: order().map(|i| velocities[i].xyz().to_array()).collect(),
        densities: order().map(|i| densities[i].x).collect(),
        pressures: order().map(|i| densities[i].y).collect(),
    }
}
