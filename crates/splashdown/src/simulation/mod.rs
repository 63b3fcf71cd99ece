//! A running simulation.

#[cfg(test)]
mod carried_tests;
mod checkpoint;
mod foam;
mod frame;
mod inventory;
mod live;
mod motion;
mod packing;
#[cfg(test)]
mod part_tests;
mod phases;
mod results;
mod start;
#[cfg(test)]
mod suspension_tests;

pub use inventory::{initial_packing, inventory};
pub use packing::{InitialDensity, Packing};

use std::sync::Arc;

use splashdown_gpu::{Executor, Gpu, Recording, Timings};

use self::frame::FrameInProgress;
use self::phases::Schedule;
use crate::Stats;
use crate::bodies::{Bodies, BodyMesh};
use crate::cells::Cells;
use crate::flow::Flow;
use crate::mouse_force::MouseForceCoupling;
use crate::probes::{ProbeRows, Probes};
use crate::scene::Scene;
use crate::schemes::SolverRounds;
use crate::solid::RepairReport;
use crate::state::{Fields, Params};

/// A simulation of a scene on one device.
///
/// ```
/// use splashdown::{Device, Simulation, scene::Scene};
/// # let text = include_str!("../../scenes/dam-break-small.toml");
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
    scene: Scene,
    params: Params,
    fields: Fields,
    cells: Cells,
    begin: Recording,
    prime: Recording,
    schedule: Schedule,
    /// The iterations that a step of the schedule records.
    solver_rounds: SolverRounds,
    /// Ends a suspended step; `None` if no step can be suspended.
    end_suspended: Option<Recording>,
    /// True from a submission until the host knows that its last step was not suspended.
    may_be_suspended: bool,
    stats: Stats,
    /// The last known stable time step in seconds.
    stable_dt: f32,
    frame: Option<FrameInProgress>,
    bodies: Option<Bodies>,
    removed: u32,
    packing: Option<Packing>,
    flow: Option<Flow>,
    probes: Option<Probes>,
    mouse_force: Option<MouseForceCoupling>,
    /// The largest number of steps in one submission.
    most_steps: u32,
    /// Rows of the probes since the last call of `take_probe_rows`.
    rows: Vec<ProbeRows>,
    /// Particles at the start.
    initial: u32,
    /// Warnings of emitters and foam since the last call of `take_warnings`.
    warnings: Vec<String>,
}

impl Simulation {
    /// The scene that is simulated now.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The statistics at the end of the last frame.
    pub fn stats(&self) -> Stats {
        self.stats
    }

    /// Simulated time in seconds and the number of steps, including the known part of the frame in progress.
    pub fn progress(&self) -> (f64, u64) {
        let known = self.frame.as_ref().and_then(|frame| frame.state);
        known.map_or((self.stats.time, self.stats.steps), |state| {
            let done = f64::from(state.frame_duration - state.remaining);
            (self.stats.time + done, self.stats.steps + u64::from(state.steps))
        })
    }

    /// The last known stable time step in seconds.
    pub fn dt(&self) -> f32 {
        self.stable_dt
    }

    /// The warnings since the last call. Each emitter warns once if its particles exceed the buffers.
    pub fn take_warnings(&mut self) -> Vec<String> {
        std::mem::take(&mut self.warnings)
    }

    /// The rows that the probes of the scene have measured in complete frames since the last call, one entry per probe
    /// in the order of the scene. Probes of the whole fluid are evaluated by a [`Run`](crate::Run), which has the
    /// particles on the host.
    pub fn take_probe_rows(&mut self) -> Vec<ProbeRows> {
        self.rows.iter_mut().map(std::mem::take).collect()
    }

    /// The meshes of the scene's bodies, in the order of the scene.
    pub fn body_meshes(&self) -> &[BodyMesh] {
        self.bodies.as_ref().map_or(&[], Bodies::meshes)
    }

    /// The number of particles of the scene that were not created because they lie inside a body.
    pub fn removed(&self) -> u32 {
        self.removed
    }

    /// How densely the particles were placed, and how they were relaxed; `None` for a single lattice without bodies.
    pub fn packing(&self) -> Option<&Packing> {
        self.packing.as_ref()
    }

    /// The repairs of the meshes of the scene's bodies, in the order of the scene.
    pub(crate) fn body_reports(&self) -> &[RepairReport] {
        self.bodies.as_ref().map_or(&[], Bodies::reports)
    }

    /// The constants of the simulation.
    #[doc(hidden)]
    pub fn params(&self) -> &Params {
        &self.params
    }

    /// The buffers of the particles, for drawing without a copy.
    #[doc(hidden)]
    pub fn fields(&self) -> &Fields {
        &self.fields
    }

    /// The executor on which the simulation runs.
    pub fn executor(&mut self) -> &mut Executor {
        &mut self.executor
    }

    /// The GPU, or `None` on the CPU.
    pub fn gpu(&self) -> Option<&Arc<Gpu>> {
        self.executor.gpu()
    }

    /// The name of the device.
    pub fn device_name(&self) -> String {
        match self.executor.gpu() {
            Some(gpu) => gpu.name(),
            None => format!("CPU ({} threads)", rayon::current_num_threads()),
        }
    }

    /// The size of all buffers in bytes.
    pub fn memory(&self) -> u64 {
        self.executor.bytes()
    }

    /// Starts timing every pass. Returns false if the device does not support it.
    pub fn enable_timing(&mut self) -> bool {
        self.executor.enable_timing()
    }

    /// Stops timing passes.
    pub fn disable_timing(&mut self) {
        self.executor.disable_timing();
    }

    /// The time per pass since the last call.
    pub fn take_timings(&mut self) -> Timings {
        self.executor.take_timings()
    }
}
