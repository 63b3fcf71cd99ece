//! A whole run as one stream of events, which command line, window and Python read.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

use splashdown_gpu::{Gpu, Timings};
use splashdown_io::{Mesh, Particles};
use web_time::Instant;

use crate::probes::ProbeRows;
use crate::scene::{Domain, Motion, Scene};
use crate::surface::Surface;
use crate::{BodyMesh, BodyState, Device, Simulation, SimulationError, Stats};

/// What to compute beside the particles' motion.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// Where to simulate.
    pub device: Device,
    /// Frames to compute; the scene's own number if `None`.
    pub frames: Option<u32>,
    /// Extract the surface in every frame.
    pub surface: bool,
    /// Measure the time of every pass.
    pub timing: bool,
    /// Who hears of what takes time before the first event.
    pub listener: Option<Listener>,
}

/// What a [`Listener`] calls: with a body's name, and how far its distances are, in [0, 1].
pub type Told = dyn Fn(&str, f32) + Send + Sync;

/// Hears of the bodies whose distances are being computed before a run's first event.
#[derive(Clone)]
pub struct Listener(pub Arc<Told>);

impl std::fmt::Debug for Listener {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Listener")
    }
}

impl RunOptions {
    /// The scene's own wishes on the best device.
    pub fn new(scene: &Scene) -> Self {
        Self {
            device: Device::Auto,
            frames: None,
            surface: scene.surface.enabled,
            timing: false,
            listener: None,
        }
    }
}

/// One thing that happened.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Event {
    /// The first event.
    Started(Started),
    /// Now and then between two frames.
    Progress(Progress),
    /// A frame is complete. Frame 0 is the initial state.
    Frame(Frame),
    /// Something the user should know; the run goes on.
    Warning(String),
    /// Something the user may want to know.
    Note(String),
    /// The last event.
    Finished(Summary),
}

/// What is about to run.
#[derive(Clone, Debug)]
pub struct Started {
    /// The device's name.
    pub device: String,
    /// Number of particles.
    pub particles: u32,
    /// Number of frames, the initial one not counted.
    pub frames: u32,
    /// Bytes in the device's buffers.
    pub memory: u64,
    /// The first time step in seconds.
    pub dt: f32,
}

/// Where the run is.
#[derive(Clone, Copy, Debug)]
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
    /// The last time step in seconds.
    pub dt: f32,
    /// Wall time since the start.
    pub wall: Duration,
}

/// A complete frame.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Number, from 0.
    pub index: u32,
    /// Simulated time in seconds.
    pub time: f64,
    /// The simulation's own account.
    pub stats: Stats,
    /// The living particles in order of id.
    pub particles: Arc<Particles>,
    /// The fluid's surface, if asked for.
    pub mesh: Option<Arc<Mesh>>,
    /// The volume that the surface encloses in m^3.
    pub volume: Option<f64>,
    /// The bodies, in the order of [`Run::bodies`].
    pub bodies: Arc<[BodyState]>,
    /// What the scene's probes measured since the frame before, in the order of the scene.
    pub probes: Arc<[ProbeRows]>,
}

/// The whole run in a few numbers.
#[derive(Clone, Debug)]
pub struct Summary {
    /// The simulation's last account.
    pub stats: Stats,
    /// Frames computed, the initial one not counted.
    pub frames: u32,
    /// Wall time of everything, in seconds.
    pub wall: f64,
    /// Wall time spent in steps, in seconds.
    pub step_wall: f64,
    /// Wall time spent in the surface and in fetching frames, in seconds.
    pub frame_wall: f64,
    /// Particles times steps per second of `step_wall`.
    pub particle_steps_per_second: f64,
    /// Simulated seconds per second of `wall`.
    pub simulated_per_wall: f64,
    /// The largest density error of all frames.
    pub density_error: f32,
    /// Enclosed volume of the first and the last surface in m^3.
    pub volume: Option<[f64; 2]>,
    /// The volume of the particles at the start, count times `particle_spacing^3`, in m^3.
    pub particle_volume: f64,
    /// Time per pass, if asked for.
    pub timings: Timings,
}

/// An excess of density that no sound has: something is told of it.
const DENSE: f32 = 0.3;

/// Time between two [`Event::Progress`].
const PROGRESS: Duration = Duration::from_millis(100);

/// Computes a scene frame by frame; an iterator over [`Event`]s, the last of which is [`Event::Finished`] or an error.
///
/// ```
/// use splashdown::{Event, Run, RunOptions, scene::Scene};
/// # let text = include_str!("../../../scenes/dam-break-small.toml");
/// let scene = Scene::parse(text, "dam-break-small.toml")?;
/// let options = RunOptions { frames: Some(1), ..RunOptions::new(&scene) };
/// for event in Run::new(&scene, options)? {
///     if let Event::Frame(frame) = event? {
///         println!("{:.3} s: {} particles", frame.time, frame.particles.positions.len());
///     }
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Run {
    simulation: Simulation,
    surface: Option<Surface>,
    frames: u32,
    frame_rate: f32,
    frame_duration: f32,
    duration: f64,
    stage: Stage,
    started: Instant,
    told: Instant,
    clock: Clock,
    density_error: f32,
    volume: Option<[f64; 2]>,
    particle_volume: f64,
    particle_steps: f64,
    waiting: VecDeque<Event>,
    /// What is wrong with the scene's probes.
    buried: Vec<String>,
    domain: Domain,
    /// One per body: true if it moves by itself and has not been told lost.
    watched: Vec<bool>,
    stats_before: Stats,
}

/// Wall time by what it was spent on.
#[derive(Default)]
struct Clock {
    steps: Duration,
    frames: Duration,
}

enum Stage {
    Start,
    /// The frame of this number is being computed.
    Steps(u32),
    /// The frame of this number has to be fetched.
    Fetch(u32),
    Finish,
    End,
}

impl Run {
    /// Places the particles and prepares the surface.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub fn new(scene: &Scene, options: RunOptions) -> Result<Self, SimulationError> {
        let started = Instant::now();
        let told = |body: &str, part: f32| {
            if let Some(Listener(listener)) = &options.listener {
                listener(body, part);
            }
        };
        let mut simulation = Simulation::prepare(scene, options.device.executor()?, &told)?;
        let buried = simulation.buried_probes(&scene.probes)?;
        let surface = if options.surface { Some(simulation.surface(&scene.surface)?) } else { None };
        if options.timing {
            simulation.enable_timing();
        }
        let frames = options.frames.unwrap_or_else(|| scene.frame_count());
        let frame_duration = scene.frame_duration();
        let particle_volume =
            f64::from(simulation.stats().particles) * f64::from(scene.fluid.particle_spacing).powi(3);
        Ok(Self {
            surface,
            frames,
            frame_rate: scene.frame_rate,
            frame_duration,
            duration: f64::from(frames) * f64::from(frame_duration),
            stage: Stage::Start,
            started,
            told: started,
            clock: Clock::default(),
            density_error: 0.0,
            volume: None,
            particle_volume,
            particle_steps: 0.0,
            waiting: VecDeque::new(),
            buried,
            domain: scene.domain.clone(),
            watched: scene.bodies.iter().map(|body| matches!(body.motion, Motion::Dynamic { .. })).collect(),
            stats_before: simulation.stats(),
            simulation,
        })
    }

    /// The device, if this does not run on the CPU: pictures are best drawn there.
    pub fn gpu(&self) -> Option<&Arc<Gpu>> {
        self.simulation.gpu()
    }

    /// The bodies' meshes, in the order of the scene.
    pub fn bodies(&self) -> &[BodyMesh] {
        self.simulation.body_meshes()
    }

    fn start(&mut self) -> Event {
        self.stage = Stage::Fetch(0);
        for (body, report) in self.simulation.body_meshes().iter().zip(self.simulation.body_reports()) {
            self.waiting.push_back(Event::Note(format!("body {:?}: {report}", body.name)));
        }
        self.waiting.extend(std::mem::take(&mut self.buried).into_iter().map(Event::Warning));
        let removed = self.simulation.removed();
        if removed > 0 {
            let text = format!("{removed} particles of the fluid were left out: they would be inside bodies");
            self.waiting.push_back(Event::Note(text));
        }
        Event::Started(Started {
            device: self.simulation.device_name(),
            particles: self.simulation.stats().particles,
            frames: self.frames,
            memory: self.simulation.memory(),
            dt: self.simulation.dt(),
        })
    }

    /// Works on a frame until there is something to tell.
    fn steps(&mut self, frame: u32) -> Result<Option<Event>, SimulationError> {
        let begun = Instant::now();
        let outcome = self.simulation.continue_frame();
        self.clock.steps += begun.elapsed();
        if let Some(stats) = outcome? {
            self.density_error = self.density_error.max(stats.density_error);
            self.particle_steps += f64::from(stats.particles) * f64::from(stats.steps_in_frame);
            self.warn(&stats);
            let told = self.simulation.take_warnings().into_iter();
            self.waiting.extend(told.map(|text| Event::Warning(format!("at {:.4} s: {text}", stats.time))));
            self.stage = Stage::Fetch(frame);
            return Ok(None);
        }
        if self.told.elapsed() < PROGRESS {
            return Ok(None);
        }
        self.told = Instant::now();
        let (time, steps) = self.simulation.progress();
        Ok(Some(Event::Progress(Progress {
            frame,
            frames: self.frames,
            time,
            duration: self.duration,
            steps,
            dt: self.simulation.dt(),
            wall: self.started.elapsed(),
        })))
    }

    /// Puts into words what was lost since the last frame.
    fn warn(&mut self, stats: &Stats) {
        let before = std::mem::replace(&mut self.stats_before, *stats);
        if stats.density_error > DENSE && before.density_error <= DENSE {
            let text = format!(
                "at {:.4} s: the density is up to {:.0} % above that at rest: more fluid than there is room for, or fluid \
                 pushed into a wall. Look at emitters in closed or narrow places, and at particles placed inside one another",
                stats.time,
                100.0 * stats.density_error
            );
            self.waiting.push_back(Event::Warning(text));
        }
        let mut tell = |more: u32, thing: &str, what: &str| {
            if more > 0 {
                let plural = if more == 1 { "" } else { "s" };
                let text = format!("at {:.4} s: {more} {thing}{plural} {what}", stats.time);
                self.waiting.push_back(Event::Warning(text));
            }
        };
        tell(stats.escaped - before.escaped, "particle", "left through open sides and taken out");
        let [x, y, z] = stats.non_finite_place;
        let lost = format!(
            "NaN or infinite and taken out; the first, id {}, was last at ({x:.4}, {y:.4}, {z:.4}) m. \
             Lower solver.cfl_factor, or look for particles placed inside one another",
            stats.non_finite_id
        );
        tell(stats.non_finite - before.non_finite, "particle", &lost);
        tell(
            stats.wall_corrections - before.wall_corrections,
            "time",
            "a particle was put back through a closed wall or the surface of a body",
        );
        tell(
            stats.speed_limits - before.speed_limits,
            "time",
            "a particle was slowed down to half a spacing per step: the time step is too long for this motion. \
             Lower solver.cfl_factor, or raise solver.sound_speed",
        );
    }

    fn fetch(&mut self, index: u32) -> Result<Frame, SimulationError> {
        let begun = Instant::now();
        let mesh = match &mut self.surface {
            Some(surface) => {
                self.simulation.extract(surface)?;
                Some(self.simulation.mesh(surface)?)
            }
            None => None,
        };
        let particles = Arc::new(self.simulation.particles()?);
        let volume = mesh.as_ref().map(Mesh::volume);
        if let Some(volume) = volume {
            let first = self.volume.map_or(volume, |[first, _]| first);
            self.volume = Some([first, volume]);
        }
        self.stage = if index < self.frames {
            self.simulation.begin(self.frame_duration)?;
            Stage::Steps(index + 1)
        } else {
            Stage::Finish
        };
        self.clock.frames += begun.elapsed();
        // The sum of frames in single precision would read 0.0199999996.
        let time = f64::from(index) / f64::from(self.frame_rate);
        let inside_bodies = self.simulation.inside_bodies(&particles)?;
        let stats = Stats { time, inside_bodies, ..self.simulation.stats() };
        if inside_bodies > 0 {
            let plural = if inside_bodies == 1 { " is" } else { "s are" };
            let text = format!("at {time:.4} s: {inside_bodies} particle{plural} inside a body");
            self.waiting.push_back(Event::Warning(text));
        }
        let bodies: Arc<[BodyState]> = self.simulation.body_states()?.into();
        self.tell_lost(&bodies, time);
        Ok(Frame {
            index,
            time,
            stats,
            particles,
            mesh: mesh.map(Arc::new),
            volume,
            bodies,
            probes: self.simulation.take_probe_rows().into(),
        })
    }

    /// Tells once of each free body that is farther outside the domain than the domain is large, or nowhere.
    fn tell_lost(&mut self, bodies: &[BodyState], time: f64) {
        let far = self.domain.size().max_element();
        for ((state, watched), mesh) in
            bodies.iter().zip(&mut self.watched).zip(self.simulation.body_meshes())
        {
            let x = state.position;
            let away = (self.domain.min - x).max(x - self.domain.max).max_element();
            if *watched && (away.is_nan() || away >= far) {
                *watched = false;
                let text =
                    format!("at {time:.4} s: body {:?} has left the domain for good, at {x} m", mesh.name);
                self.waiting.push_back(Event::Warning(text));
            }
        }
    }

    fn finish(&mut self) -> Event {
        self.stage = Stage::End;
        let stats = self.simulation.stats();
        let wall = self.started.elapsed().as_secs_f64();
        let step_wall = self.clock.steps.as_secs_f64();
        Event::Finished(Summary {
            stats,
            frames: self.frames,
            wall,
            step_wall,
            frame_wall: self.clock.frames.as_secs_f64(),
            particle_steps_per_second: self.particle_steps / step_wall.max(f64::MIN_POSITIVE),
            simulated_per_wall: stats.time / wall,
            density_error: self.density_error,
            volume: self.volume,
            particle_volume: self.particle_volume,
            timings: self.simulation.take_timings(),
        })
    }
}

impl Iterator for Run {
    type Item = Result<Event, SimulationError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(event) = self.waiting.pop_front() {
                return Some(Ok(event));
            }
            let outcome = match self.stage {
                Stage::Start => Ok(Some(self.start())),
                Stage::Steps(frame) => self.steps(frame),
                Stage::Fetch(frame) => self.fetch(frame).map(|frame| Some(Event::Frame(frame))),
                Stage::Finish => Ok(Some(self.finish())),
                Stage::End => return None,
            };
            match outcome {
                Ok(None) => {}
                Ok(Some(event)) => return Some(Ok(event)),
                Err(error) => {
                    self.stage = Stage::End;
                    return Some(Err(error));
                }
            }
        }
    }
}
