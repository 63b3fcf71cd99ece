//! Computes all frames of a scene and reports them as a stream of events.

mod events;
mod resume;
mod warnings;

pub use events::{Event, Frame, Progress, ProgressFn, RunOptions, Started, Summary};

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

use splashdown_gpu::Gpu;
use web_time::Instant;

use crate::check::Built;
use crate::foam::Foam;
use crate::monitor::{EnergyBalance, Monitor};
use crate::probes::FluidProbes;
use crate::scene::{Domain, Motion, OnBurst, Scene};
use crate::surface::{Surface, interpolate};
use crate::{BodyMesh, BodyState, Simulation, SimulationError, Stats};

/// Time between two [`Event::Progress`].
const PROGRESS: Duration = Duration::from_millis(100);

/// Computes a scene frame by frame; an iterator over [`Event`]s, the last of which is [`Event::Finished`] or an error.
///
/// ```
/// use splashdown::{Event, Run, RunOptions, scene::Scene};
/// # let text = include_str!("../../scenes/dam-break-small.toml");
/// let scene = Scene::parse(text, "dam-break-small.toml")?;
/// let options = RunOptions::new(&scene).with_frames(1);
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
    foam: Option<Foam>,
    vertex_velocities: bool,
    fluid_probes: FluidProbes,
    monitor: Monitor,
    energy: EnergyBalance,
    on_burst: OnBurst,
    frames: u32,
    frame_rate: f32,
    frame_duration: f32,
    duration: f64,
    stage: Stage,
    /// The frame at the start of the run: 0, or that of a checkpoint.
    first: u32,
    /// The last frame that was returned, or that of the checkpoint.
    complete: Option<u32>,
    /// Steps before this run.
    steps_before: u64,
    /// The rest of the next frame in seconds, if the run does not start between two frames.
    next_duration: Option<f32>,
    scene_text: Arc<str>,
    started: Instant,
    /// Time of the last progress report.
    reported: Instant,
    clock: Clock,
    /// The largest excess and deficit of all frames.
    density: [f32; 2],
    residual: f32,
    volume: Option<[f64; 2]>,
    particle_volume: f64,
    volume_per_particle: f64,
    particle_steps: f64,
    pending_events: VecDeque<Event>,
    /// Warnings about the scene's probes.
    probe_warnings: Vec<String>,
    domain: Domain,
    /// For each body, whether it is dynamic and has not been reported as lost.
    watched: Vec<bool>,
    /// Particles that had left through open sides at the last note.
    escaped: u32,
    /// The particles that the emitters would add during the whole scene with nothing in their way, without those in sinks.
    planned_emission: u64,
    /// The frames of the whole scene.
    scene_frames: u32,
    /// The statistics of the last frame.
    last: Stats,
    /// Simulated time at the start in seconds.
    start_time: f64,
}

/// Wall time by purpose.
#[derive(Default)]
struct Clock {
    steps: Duration,
    frames: Duration,
    monitor: Duration,
}

enum Stage {
    Start,
    /// The frame with this number starts.
    Begin(u32),
    /// The frame with this number is being computed.
    Steps(u32),
    /// The frame with this number is complete and must be fetched.
    Fetch(u32),
    /// The fluid has burst, and the events before the error are not all reported.
    Burst(SimulationError),
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
        let simulation = Simulation::prepare(scene, options.device.executor()?, &options.report_progress())?;
        Self::of(simulation, scene, options, started)
    }

    fn of(
        mut simulation: Simulation,
        scene: &Scene,
        options: RunOptions,
        started: Instant,
    ) -> Result<Self, SimulationError> {
        let probe_warnings = simulation.buried_probes(&scene.probes)?;
        let surface = if options.surface { Some(simulation.surface(&scene.surface)?) } else { None };
        let foam = if options.foam { Some(simulation.foam(&scene.foam)?) } else { None };
        if options.timing {
            simulation.enable_timing();
        }
        let frames = options.frames.unwrap_or_else(|| scene.frame_count());
        let frame_duration = scene.frame_duration();
        let volume_per_particle = f64::from(scene.fluid.particle_spacing).powi(3);
        let particle_volume = f64::from(simulation.stats().particles) * volume_per_particle;
        Ok(Self {
            surface,
            foam,
            vertex_velocities: options.vertex_velocities,
            fluid_probes: FluidProbes::of(scene),
            monitor: simulation.monitor(),
            energy: EnergyBalance::default(),
            on_burst: options.on_burst,
            frames,
            frame_rate: scene.frame_rate,
            frame_duration,
            duration: f64::from(frames) * f64::from(frame_duration),
            stage: Stage::Start,
            first: 0,
            complete: None,
            steps_before: simulation.stats().steps,
            next_duration: None,
            scene_text: Arc::clone(&scene.text),
            started,
            reported: started,
            clock: Clock::default(),
            density: [0.0; 2],
            residual: 0.0,
            volume: None,
            particle_volume,
            volume_per_particle,
            particle_steps: 0.0,
            pending_events: VecDeque::new(),
            probe_warnings,
            domain: scene.domain.clone(),
            watched: scene.bodies.iter().map(|body| matches!(body.motion, Motion::Dynamic { .. })).collect(),
            escaped: simulation.stats().escaped,
            scene_frames: scene.frame_count(),
            planned_emission: Built::of(scene).flow(scene).map_or(0, |flow| flow.planned(scene.duration)),
            last: simulation.stats(),
            start_time: simulation.stats().time,
            simulation,
        })
    }

    /// The GPU, unless the run is on the CPU. Pictures are best drawn on the same device.
    pub fn gpu(&self) -> Option<&Arc<Gpu>> {
        self.simulation.gpu()
    }

    /// The frame at the start of the run: 0, or that of the checkpoint it resumes from.
    pub fn first_frame(&self) -> u32 {
        self.first
    }

    /// The bodies' meshes, in the order of the scene.
    pub fn bodies(&self) -> &[BodyMesh] {
        self.simulation.body_meshes()
    }

    fn start(&mut self) -> Event {
        // A run that is resumed after frame 0 does not repeat it.
        let is_new = self.complete.is_none() && self.next_duration.is_none();
        self.stage = if is_new { Stage::Fetch(0) } else { self.after(self.first) };
        for (body, report) in self.simulation.body_meshes().iter().zip(self.simulation.body_reports()) {
            self.pending_events.push_back(Event::Note(format!("body {:?}: {report}", body.name)));
        }
        self.pending_events.extend(std::mem::take(&mut self.probe_warnings).into_iter().map(Event::Warning));
        let removed = self.simulation.removed();
        if removed > 0 {
            let all = f64::from(removed) + f64::from(self.simulation.stats().particles);
            let text = format!(
                "{removed} particles of the fluid, {:.1} % of it, were removed because they are inside bodies or in narrow gaps",
                100.0 * f64::from(removed) / all
            );
            self.pending_events.push_back(Event::Note(text));
        }
        if let Some(packing) = self.simulation.packing().filter(|packing| packing.after.is_some()) {
            let text = format!("initial packing: {packing}");
            self.pending_events.push_back(if packing.is_sound() {
                Event::Note(text)
            } else {
                Event::Warning(format!("{text}; {}", packing.advice()))
            });
        }
        Event::Started(Started {
            device: self.simulation.device_name(),
            particles: self.simulation.stats().particles,
            first_frame: self.first,
            time: self.simulation.stats().time,
            steps: self.simulation.stats().steps,
            frames: self.frames,
            memory: self.simulation.memory(),
            dt: self.simulation.dt(),
            tolerance: self.tolerance(),
        })
    }

    /// Computes steps of a frame until there is an event.
    fn steps(&mut self, frame: u32) -> Result<Option<Event>, SimulationError> {
        let begun = Instant::now();
        let outcome = self.simulation.continue_frame();
        self.clock.steps += begun.elapsed();
        let complete = match outcome {
            Err(error @ SimulationError::StepTooSmall { .. }) => {
                let error = self.explain(error)?;
                self.stage = Stage::Burst(error);
                return Ok(None);
            }
            outcome => outcome?,
        };
        if let Some(stats) = complete {
            self.particle_steps += f64::from(stats.particles) * f64::from(stats.steps_in_frame);
            self.note_escaped(&stats);
            self.warn_of_pressure(&stats);
            self.warn_of_viscosity(&stats);
            if frame == self.frames {
                self.warn_of_blocked_emitters(&stats);
            }
            self.stage = Stage::Fetch(frame);
            return Ok(None);
        }
        if let Some(foam) = &self.foam {
            self.simulation.advance_foam(foam)?;
        }
        if self.reported.elapsed() < PROGRESS {
            return Ok(None);
        }
        self.reported = Instant::now();
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

    /// Lets the monitor examine the state in which a frame could not be continued, and adds what it finds.
    fn explain(&mut self, mut error: SimulationError) -> Result<SimulationError, SimulationError> {
        let particles = self.simulation.particles()?;
        let inside_bodies = self.simulation.inside_bodies(&particles)?;
        let bodies = self.simulation.body_states()?;
        let stats = Stats { inside_bodies, ..self.simulation.stats() };
        let now = (stats.time, &stats);
        let alarms = self.simulation.examine(&mut self.monitor, now, &particles, &bodies).alarms;
        if let (SimulationError::StepTooSmall { cause, .. }, Some(alarm)) = (&mut error, alarms.first()) {
            *cause = Some(alarm.message.clone());
        }
        self.pending_events.extend(alarms.into_iter().map(Event::Alarm));
        Ok(error)
    }

    /// The stage after a frame.
    fn after(&self, frame: u32) -> Stage {
        if frame < self.frames { Stage::Begin(frame + 1) } else { Stage::Finish }
    }

    fn fetch(&mut self, index: u32) -> Result<Frame, SimulationError> {
        let begun = Instant::now();
        // A sum of frame durations in single precision would give 0.0199999996.
        let time = f64::from(index) / f64::from(self.frame_rate);
        let (mut mesh, mut droplets) = match &mut self.surface {
            Some(surface) => {
                self.simulation.extract(surface)?;
                let separates = surface.params().separates();
                let droplets = separates.then(|| self.simulation.droplets(surface)).transpose()?;
                (Some(self.simulation.mesh(surface)?), droplets)
            }
            None => (None, None),
        };
        let foam = match &mut self.foam {
            Some(foam) => {
                self.simulation.advance_foam(foam)?;
                Some(Arc::new(self.simulation.diffuse(foam)?))
            }
            None => None,
        };
        let mut particles = self.simulation.particles()?;
        for points in [Some(&mut particles), droplets.as_mut()].into_iter().flatten() {
            points.info.time = Some(time);
        }
        let particles = Arc::new(particles);
        if let (Some(mesh), Some(surface), true) = (&mut mesh, &self.surface, self.vertex_velocities) {
            let (positions, velocities) = (&particles.positions, &particles.velocities);
            mesh.velocities = interpolate(&mesh.vertices, positions, velocities, surface.params())?;
        }
        let droplet_volume =
            droplets.as_ref().map_or(0.0, |droplets| droplets.len() as f64 * self.volume_per_particle);
        let volume = mesh.as_ref().map(|mesh| mesh.volume() + droplet_volume);
        if let Some(volume) = volume {
            let first = self.volume.map_or(volume, |[first, _]| first);
            self.volume = Some([first, volume]);
        }
        self.stage = self.after(index);
        self.complete = Some(index);
        self.clock.frames += begun.elapsed();
        let warnings = self.simulation.take_warnings().into_iter();
        self.pending_events.extend(warnings.map(|text| Event::Warning(format!("at {time:.4} s: {text}"))));
        let inside_bodies = self.simulation.inside_bodies(&particles)?;
        let bodies: Arc<[BodyState]> = self.simulation.body_states()?.into();
        let stats = Stats { time, inside_bodies, ..self.simulation.stats() };
        let examined = Instant::now();
        let found = self.simulation.examine(&mut self.monitor, (time, &stats), &particles, &bodies);
        self.clock.monitor += examined.elapsed();
        let (energy, density) = (found.energy, found.density);
        self.energy = energy;
        self.report(found.alarms);
        let stats = Stats {
            density_error: density.excess.max(density.deficit),
            density_excess: density.excess,
            density_deficit: density.deficit,
            ..stats
        };
        self.density = [self.density[0].max(density.excess), self.density[1].max(density.deficit)];
        self.residual = self.residual.max(stats.residual);
        self.last = stats;
        let mut probes = self.simulation.take_probe_rows();
        self.fluid_probes.read(&mut probes, time, &particles, &energy.terms());
        self.warn_of_lost_bodies(&bodies, time);
        Ok(Frame {
            index,
            time,
            stats,
            energy,
            density,
            level: self.monitor.level(),
            particles,
            mesh: mesh.map(Arc::new),
            droplets: droplets.map(Arc::new),
            volume,
            foam,
            bodies,
            probes: probes.into(),
        })
    }

    /// The tolerance of an implicit pressure.
    fn tolerance(&self) -> Option<f32> {
        let params = self.simulation.params();
        (params.is_implicit == 1).then_some(params.tolerance)
    }

    fn finish(&mut self) -> Event {
        self.stage = Stage::End;
        // The time of the simulation is exact; a frame has its nominal time.
        let stats = Stats { time: self.simulation.stats().time, ..self.last };
        let wall = self.started.elapsed().as_secs_f64();
        let step_wall = self.clock.steps.as_secs_f64();
        Event::Finished(Summary {
            stats,
            frames: self.frames,
            steps: stats.steps.saturating_sub(self.steps_before),
            wall,
            step_wall,
            frame_wall: self.clock.frames.as_secs_f64(),
            monitor_wall: self.clock.monitor.as_secs_f64(),
            particle_steps_per_second: self.particle_steps / step_wall.max(f64::MIN_POSITIVE),
            simulated_per_wall: (stats.time - self.start_time) / wall,
            density_excess: self.density[0],
            density_deficit: self.density[1],
            tolerance: self.tolerance(),
            residual: self.residual,
            energy: self.energy,
            level: self.monitor.level(),
            volume: self.volume,
            particle_volume: [self.particle_volume, f64::from(stats.particles) * self.volume_per_particle],
            timings: self.simulation.take_timings(),
        })
    }
}

impl Iterator for Run {
    type Item = Result<Event, SimulationError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(event) = self.pending_events.pop_front() {
                return Some(Ok(event));
            }
            let stage = std::mem::replace(&mut self.stage, Stage::End);
            let outcome = match stage {
                Stage::Start => Ok(Some(self.start())),
                Stage::Begin(frame) => {
                    let duration = self.next_duration.take().unwrap_or(self.frame_duration);
                    self.stage = Stage::Steps(frame);
                    self.simulation.begin(duration).map(|()| None)
                }
                Stage::Steps(frame) => {
                    self.stage = Stage::Steps(frame);
                    self.steps(frame)
                }
                Stage::Fetch(frame) => self.fetch(frame).map(|frame| Some(Event::Frame(frame))),
                Stage::Burst(error) => Err(error),
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
