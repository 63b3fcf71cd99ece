//! A running simulation.

mod checkpoint;
mod foam;
mod frame;
mod inventory;
mod live;
mod phases;
mod results;
mod start;

pub use inventory::inventory;

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
use crate::solid::RepairReport;
use crate::state::{Fields, Params};

/// A fluid in its box, with everything that moves it, on one device.
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
    stats: Stats,
    /// What `stable_dt` was when last heard of, in seconds.
    stable_dt: f32,
    frame: Option<FrameInProgress>,
    bodies: Option<Bodies>,
    removed: u32,
    flow: Option<Flow>,
    probes: Option<Probes>,
    mouse_force: Option<MouseForceCoupling>,
    /// Most steps in one submission.
    most_steps: u32,
    /// Rows of the probes since they were last asked for.
    rows: Vec<ProbeRows>,
    /// Particles at the start.
    initial: u32,
    /// What the emitters had to tell since it was last asked for.
    told: Vec<String>,
}

impl Simulation {
    /// The scene as it is simulated now.
    pub fn scene(&self) -> &Scene {
        &self.scene
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

    /// What emitters had to tell since the last call: each says once when it found no room.
    pub fn take_warnings(&mut self) -> Vec<String> {
        std::mem::take(&mut self.told)
    }

    /// What the scene's probes have measured in whole frames since the last call: rows of each, in the scene's order.
    /// Those of the whole fluid come from a [`Run`](crate::Run), which has the particles on the host.
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

    /// From now on passes are not timed.
    pub fn disable_timing(&mut self) {
        self.executor.disable_timing();
    }

    /// Time per pass since the last call.
    pub fn take_timings(&mut self) -> Timings {
        self.executor.take_timings()
    }
}
