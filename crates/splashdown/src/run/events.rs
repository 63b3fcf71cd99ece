//! The options of a run, and its events.

use std::sync::Arc;
use std::time::Duration;

use splashdown_gpu::Timings;
use splashdown_io::{Mesh, Particles};

use crate::foam::DiffuseParticles;
use crate::monitor::{Alarm, DensityError, EnergyBalance, Level};
use crate::probes::ProbeRows;
use crate::scene::{OnBurst, Scene};
use crate::{BodyState, Device, Stats};

/// Options of a run: the device, and what is computed in addition to the motion of particles.
///
/// ```
/// use splashdown::{Device, RunOptions, Scene};
/// # let scene = Scene::parse(include_str!("../../scenes/dam-break-small.toml"), "dam-break-small.toml")?;
/// let mut options = RunOptions::new(&scene).with_device(Device::Cpu).with_frames(10);
/// options.timing = true;
/// # Ok::<(), splashdown::error::SceneErrors>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RunOptions {
    /// The device that runs the simulation.
    pub device: Device,
    /// Number of frames to compute; `None` for the number of the scene.
    pub frames: Option<u32>,
    /// Extract the surface in every frame.
    pub surface: bool,
    /// Compute foam, spray and bubbles.
    pub foam: bool,
    /// Interpolate the particles' velocities to the vertices of the surface, for motion blur.
    pub vertex_velocities: bool,
    /// Measure the time of every pass.
    pub timing: bool,
    /// What to do when the fluid bursts.
    pub on_burst: OnBurst,
    /// Called while the distance fields of bodies are computed and the initial packing is relaxed, before the first event.
    pub progress: Option<ProgressFn>,
}

/// A callback for what precedes the first step. Its arguments are what is being prepared, such as `initial packing` or
/// `distance field of "tug"`, and the completed fraction in [0, 1]. Several threads may call it at once.
#[derive(Clone)]
pub struct ProgressFn(Arc<Report>);

/// The function that [`ProgressFn`] wraps.
type Report = dyn Fn(&str, f32) + Send + Sync;

impl ProgressFn {
    /// Wraps a function.
    pub fn new(progress: impl Fn(&str, f32) + Send + Sync + 'static) -> Self {
        Self(Arc::new(progress))
    }

    /// Calls it.
    pub fn call(&self, task: &str, fraction: f32) {
        (self.0)(task, fraction);
    }
}

impl std::fmt::Debug for ProgressFn {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("ProgressFn")
    }
}

impl RunOptions {
    /// The options of the scene, on the best device.
    pub fn new(scene: &Scene) -> Self {
        Self {
            device: Device::Auto,
            frames: None,
            surface: scene.surface.enabled,
            foam: scene.foam.enabled,
            vertex_velocities: scene.output.formats.iter().any(|format| format.has_vertex_velocities()),
            timing: false,
            on_burst: OnBurst::Stop,
            progress: None,
        }
    }

    /// The same options on this device.
    pub fn with_device(self, device: Device) -> Self {
        Self { device, ..self }
    }

    /// The same options with this reaction to a burst.
    pub fn with_on_burst(self, on_burst: OnBurst) -> Self {
        Self { on_burst, ..self }
    }

    /// The same options with this number of frames, after the initial one.
    pub fn with_frames(self, frames: u32) -> Self {
        Self { frames: Some(frames), ..self }
    }

    /// The same options with or without the surface.
    pub fn with_surface(self, surface: bool) -> Self {
        Self { surface, ..self }
    }

    /// Calls the progress callback, if there is one.
    pub(super) fn report_progress(&self) -> impl Fn(&str, f32) + Sync {
        |task, fraction| {
            if let Some(progress) = &self.progress {
                progress.call(task, fraction);
            }
        }
    }
}

/// An event of a run.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Event {
    /// The first event.
    Started(Started),
    /// Progress between two frames.
    Progress(Progress),
    /// A frame is complete. Frame 0 is the initial state.
    Frame(Frame),
    /// A problem that does not stop the run.
    Warning(String),
    /// A watched quantity has risen to a new level. After an alarm of the level [`Level::Stop`] the run ends with
    /// [`SimulationError::Burst`](crate::SimulationError::Burst), unless [`RunOptions::on_burst`] says otherwise.
    Alarm(Alarm),
    /// Information.
    Note(String),
    /// The last event.
    Finished(Summary),
}

/// The start of a run.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Started {
    /// The device's name.
    pub device: String,
    /// Number of particles.
    pub particles: u32,
    /// The first frame: 0, or that of the checkpoint that the run resumes from.
    pub first_frame: u32,
    /// Number of frames, without the initial one.
    pub frames: u32,
    /// Simulated time in seconds.
    pub time: f64,
    /// Steps so far.
    pub steps: u64,
    /// Bytes in the device's buffers.
    pub memory: u64,
    /// The first time step in seconds.
    pub dt: f32,
    /// The mean residual of the density at which the pressure iterations stop, over the rest density; `None` if the pressure
    /// is explicit.
    pub tolerance: Option<f32>,
}

/// The progress of a run.
#[derive(Clone, Copy, Debug, Default)]
#[non_exhaustive]
pub struct Progress {
    /// The frame being computed.
    pub frame: u32,
    /// Number of frames.
    pub frames: u32,
    /// Simulated time in seconds.
    pub time: f64,
    /// Simulated time at the end in seconds.
    pub duration: f64,
    /// Steps since the start.
    pub steps: u64,
    /// The largest stable time step in seconds.
    pub dt: f32,
    /// Wall time since the start.
    pub wall: Duration,
}

/// A complete frame.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Frame {
    /// Number, from 0.
    pub index: u32,
    /// Simulated time in seconds.
    pub time: f64,
    /// The statistics of the simulation.
    pub stats: Stats,
    /// The energy balance.
    pub energy: EnergyBalance,
    /// The density by the positions of the particles.
    pub density: DensityError,
    /// The highest level of the monitor so far.
    pub level: Level,
    /// The particles in order of id.
    pub particles: Arc<Particles>,
    /// The surface of the fluid, if enabled.
    pub mesh: Option<Arc<Mesh>>,
    /// The isolated particles, which are not part of the mesh, if they leave the surface: ids, positions and velocities,
    /// and their diameter in m as the attribute `width`.
    pub droplets: Option<Arc<Particles>>,
    /// The volume in m^3 that the surface encloses, plus that of the droplets.
    pub volume: Option<f64>,
    /// Foam, spray and bubbles, if enabled.
    pub foam: Option<Arc<DiffuseParticles>>,
    /// The bodies, in the order of [`Run::bodies`](crate::Run::bodies).
    pub bodies: Arc<[BodyState]>,
    /// The samples of the scene's probes since the previous frame, in the order of the scene.
    pub probes: Arc<[ProbeRows]>,
}

/// The summary of a run.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Summary {
    /// The final statistics of the simulation.
    pub stats: Stats,
    /// Number of frames, without the initial one.
    pub frames: u32,
    /// Steps of this run, without those before the checkpoint it resumed from.
    pub steps: u64,
    /// Total wall time in seconds.
    pub wall: f64,
    /// Wall time of the steps in seconds.
    pub step_wall: f64,
    /// Wall time of surface extraction and of reading frames back, in seconds.
    pub frame_wall: f64,
    /// Wall time of the monitor, in seconds.
    pub monitor_wall: f64,
    /// Particles times steps per second of `step_wall`.
    pub particle_steps_per_second: f64,
    /// Simulated seconds per second of `wall`.
    pub simulated_per_wall: f64,
    /// The largest relative excess of density of all frames, as [`Stats::density_excess`].
    pub density_excess: f32,
    /// The largest relative deficit of density of all frames, as [`Stats::density_deficit`].
    pub density_deficit: f32,
    /// The mean residual of the density at which the pressure iterations stop, over the rest density; `None` if the pressure
    /// is explicit.
    pub tolerance: Option<f32>,
    /// The largest mean residual of the density at which the iterations of a step stopped, since the start or the checkpoint;
    /// zero if the pressure is explicit.
    pub residual: f32,
    /// The energy balance at the end.
    pub energy: EnergyBalance,
    /// The highest level of the monitor.
    pub level: Level,
    /// Volume of the first and the last surface with its droplets in m^3.
    pub volume: Option<[f64; 2]>,
    /// The volume of the particles at the start and at the end, count times `particle_spacing^3`, in m^3.
    pub particle_volume: [f64; 2],
    /// Time per pass, if enabled.
    pub timings: Timings,
}

impl Summary {
    /// The larger one of [`density_excess`](Self::density_excess) and [`density_deficit`](Self::density_deficit).
    pub fn density_error(&self) -> f32 {
        self.density_excess.max(self.density_deficit)
    }
}
