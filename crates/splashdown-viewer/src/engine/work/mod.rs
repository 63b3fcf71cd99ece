//! The worker of the engine: executes commands, simulates, takes snapshots.

mod meter;
mod show;
mod watch;

use std::sync::{Arc, Mutex};
use std::time::Duration;

use splashdown::foam::{Foam, KeptFoam};
use splashdown::scene::Scene;
use splashdown::surface::Surface;
use splashdown::{BodyMesh, Checkpoint, Device, MouseForce, Simulation, SimulationError};
use splashdown_gpu::{Executor, Gpu, GpuExecutor};
use web_time::Instant;

use super::drawn::Copies;
use super::inbox::Inbox;
use super::pace::Pace;
use super::{Command, Grip, Message, Opened, Outbox, Purpose, Simulate, lock};
use meter::Meter;
use watch::Watch;

/// Wall time in s of the steps submitted at once. The window can draw between two submissions.
const BATCH: f64 = 0.008;
/// Sleep while no tick is due.
const SHORT_SLEEP: Duration = Duration::from_millis(2);
/// Sleep while paused; a command ends it.
const LONG_SLEEP: Duration = Duration::from_millis(200);
/// Rate at which a held body follows the mouse, in 1/s.
const GRIP_RATE: f32 = 12.0;

pub(super) struct Worker {
    gpu: Arc<Gpu>,
    simulate: Simulate,
    inbox: Arc<Inbox>,
    outbox: Arc<Mutex<Outbox>>,
    repaint: Box<dyn Fn()>,
    copies: Copies,
    simulation: Option<Simulation>,
    surface: Option<Surface>,
    foam: Option<Foam>,
    /// Foam of the previous simulation or of a checkpoint, with which the next simulation starts.
    saved_foam: Option<KeptFoam>,
    opened: Option<Arc<Opened>>,
    playing: bool,
    /// A scene could not be opened: the command to play that was sent with it has no effect.
    ignores_play: bool,
    wants_surface: bool,
    wants_timing: bool,
    mouse_force: Option<MouseForce>,
    grip: Option<Grip>,
    pace: Pace,
    meter: Meter,
    watch: Watch,
}

impl Worker {
    pub fn new(
        gpu: Arc<Gpu>,
        simulate: Simulate,
        inbox: Arc<Inbox>,
        outbox: Arc<Mutex<Outbox>>,
        repaint: Box<dyn Fn()>,
    ) -> Self {
        Self {
            copies: Copies::new(Arc::clone(&gpu)),
            gpu,
            simulate,
            inbox,
            outbox,
            repaint,
            simulation: None,
            surface: None,
            foam: None,
            saved_foam: None,
            opened: None,
            playing: false,
            ignores_play: false,
            wants_surface: false,
            wants_timing: false,
            mouse_force: None,
            grip: None,
            pace: Pace::new(),
            meter: Meter::new(),
            watch: Watch::default(),
        }
    }

    /// Works until [`Command::Quit`].
    pub async fn work(&mut self) {
        loop {
            for command in self.inbox.take() {
                if matches!(command, Command::Quit) {
                    return;
                }
                if let Err(error) = self.execute(command).await {
                    self.fail(&error);
                }
            }
            let due = match &self.simulation {
                Some(simulation) if self.playing => self.pace.tick(Instant::now(), simulation.dt().into()),
                _ => None,
            };
            match due {
                Some(seconds) => {
                    if let Err(error) = self.advance(seconds as f32).await {
                        self.fail(&error);
                    }
                }
                None => self.inbox.sleep(if self.playing { SHORT_SLEEP } else { LONG_SLEEP }).await,
            }
        }
    }

    async fn execute(&mut self, command: Command) -> Result<(), SimulationError> {
        match command {
            Command::Open(scene) => {
                let opened = self.open(*scene).await;
                self.ignores_play = opened.is_err();
                return opened;
            }
            Command::Change(scene) => {
                // A refused change leaves the simulation as it is.
                if let Err(error) = self.change(*scene).await {
                    lock(&lock(&self.outbox).messages).push(Message::Refused(error.to_string()));
                    (self.repaint)();
                }
            }
            Command::Play(playing) => {
                if std::mem::take(&mut self.ignores_play) {
                    return Ok(());
                }
                if playing {
                    self.reopen().await?;
                }
                self.playing = playing && self.simulation.is_some();
                self.pace.pause();
                self.meter.pause();
                return self.show().await;
            }
            Command::Advance(seconds) => {
                self.playing = false;
                self.reopen().await?;
                return self.advance(seconds).await;
            }
            Command::TimeScale(scale) => self.pace.set_scale(scale),
            Command::MouseForce(force) => {
                self.mouse_force = force;
                if let Some(simulation) = &mut self.simulation {
                    simulation.set_mouse_force(force)?;
                }
            }
            Command::Grip(grip) => self.grip = grip,
            Command::Surface(wanted) => {
                if std::mem::replace(&mut self.wants_surface, wanted) != wanted {
                    if !wanted {
                        self.free_surface()?;
                    }
                    return self.show().await;
                }
            }
            Command::Timing(wanted) => {
                self.wants_timing = wanted;
                if let Some(simulation) = &mut self.simulation {
                    if wanted {
                        simulation.enable_timing();
                    } else {
                        simulation.disable_timing();
                    }
                }
            }
            Command::Export => {
                self.reopen().await?;
                return self.export().await;
            }
            Command::Checkpoint(text, purpose) => {
                if matches!(purpose, Purpose::Export) {
                    self.reopen().await?;
                }
                return self.checkpoint(&text, purpose).await;
            }
            Command::Resume(checkpoint) => {
                let resumed = self.resume(&checkpoint).await;
                self.ignores_play = resumed.is_err();
                return resumed;
            }
            Command::Quit => {}
        }
        Ok(())
    }

    fn executor(&self) -> Result<Executor, SimulationError> {
        match self.simulate {
            Simulate::WhereDrawn => Ok(GpuExecutor::new(Arc::clone(&self.gpu)).into()),
            Simulate::OnCpu => Ok(Device::Cpu.executor()?),
        }
    }

    async fn open(&mut self, scene: Scene) -> Result<(), SimulationError> {
        let (executor, progress) = self.free_simulation()?;
        let simulation = Simulation::prepare_async(&scene, executor, &progress).await?;
        self.saved_foam = None;
        self.begin(simulation).await
    }

    /// Opens the scene that is shown again, if its simulation was freed for one that could not be opened.
    async fn reopen(&mut self) -> Result<(), SimulationError> {
        match (&self.simulation, &self.opened) {
            (None, Some(opened)) => {
                let scene = opened.scene.clone();
                self.open(scene).await
            }
            _ => Ok(()),
        }
    }

    async fn resume(&mut self, checkpoint: &Checkpoint) -> Result<(), SimulationError> {
        let (executor, progress) = self.free_simulation()?;
        let simulation = Simulation::resume_async(checkpoint, executor, &progress).await?;
        self.saved_foam = checkpoint.foam()?;
        self.begin(simulation).await
    }

    /// Frees the running simulation, whose memory may be needed. Returns an executor for the next one, and a callback for
    /// the progress of its distance fields.
    fn free_simulation(&mut self) -> Result<(Executor, impl Fn(&str, f32) + Sync + use<>), SimulationError> {
        let executor = match self.simulation.take() {
            Some(mut old) => old.executor().successor(),
            None => self.executor()?,
        };
        self.surface = None;
        self.copies = Copies::new(Arc::clone(&self.gpu));
        let messages = Arc::clone(&lock(&self.outbox).messages);
        let progress = move |body: &str, fraction: f32| {
            lock(&messages).push(Message::Preparing(body.to_owned(), fraction));
        };
        Ok((executor, progress))
    }

    /// Frees the buffers of the surface, which are often larger than those of the simulation. The next extraction
    /// creates them again.
    fn free_surface(&mut self) -> Result<(), SimulationError> {
        if let (Some(simulation), Some(surface)) = (&mut self.simulation, self.surface.take()) {
            surface.free(simulation.executor())?;
        }
        Ok(())
    }

    async fn checkpoint(&mut self, text: &str, purpose: Purpose) -> Result<(), SimulationError> {
        let Some(simulation) = &mut self.simulation else { return Ok(()) };
        let mut checkpoint = Box::new(simulation.checkpoint_async(text).await?);
        if let (Some(foam), true) = (&self.foam, simulation.scene().foam.enabled) {
            checkpoint.set_foam(&simulation.keep_foam_async(foam).await?);
        }
        lock(&lock(&self.outbox).messages).push(Message::Checkpoint(checkpoint, purpose));
        (self.repaint)();
        Ok(())
    }

    async fn change(&mut self, scene: Scene) -> Result<(), SimulationError> {
        let Some(simulation) = &mut self.simulation else { return self.open(scene).await };
        let surface_differs = simulation.scene().surface != scene.surface;
        let foam_differs = simulation.scene().foam != scene.foam;
        if simulation.update_parameters(&scene)? {
            self.watch.restart();
            if foam_differs && let Some(foam) = &self.foam {
                // Existing foam would not match the water.
                foam.clear(simulation.executor())?;
            }
            if surface_differs {
                self.free_surface()?;
            }
            // The bodies are unchanged, so the picture can reuse their buffers.
            let bodies = self.opened.as_ref().map(|opened| Arc::clone(&opened.bodies));
            self.publish_scene(bodies);
            return self.show().await;
        }
        let next = simulation.carry_over_async(&scene).await?;
        self.saved_foam = match &self.foam {
            Some(foam) if simulation.scene().foam.enabled => Some(simulation.keep_foam_async(foam).await?),
            _ => None,
        };
        self.begin(next).await
    }

    /// Replaces the simulation.
    async fn begin(&mut self, mut simulation: Simulation) -> Result<(), SimulationError> {
        if self.wants_timing {
            simulation.enable_timing();
        }
        simulation.set_mouse_force(self.mouse_force)?;
        self.simulation = Some(simulation);
        self.surface = None;
        self.foam = None;
        self.grip = None;
        self.pace.reset();
        self.meter = Meter::new();
        self.watch = Watch::default();
        self.publish_scene(None);
        self.show().await
    }

    fn publish_scene(&mut self, bodies: Option<Arc<[BodyMesh]>>) {
        let Some(simulation) = &self.simulation else { return };
        self.opened = Some(Arc::new(Opened {
            scene: simulation.scene().clone(),
            bodies: bodies.unwrap_or_else(|| simulation.body_meshes().into()),
            device: simulation.device_name(),
            memory: simulation.memory(),
        }));
    }

    async fn advance(&mut self, seconds: f32) -> Result<(), SimulationError> {
        let begun = Instant::now();
        let Some(simulation) = &mut self.simulation else { return Ok(()) };
        if let Some(grip) = self.grip {
            simulation.pull_body_async(grip.body, grip.anchor, grip.target, GRIP_RATE).await?;
        }
        let before = simulation.stats();
        let stats = simulation.advance_async(seconds).await?;
        if let (Some(foam), true) = (&self.foam, simulation.scene().foam.enabled) {
            simulation.advance_foam(foam)?;
        }
        let steps = (stats.steps - before.steps) as u32;
        let warnings = simulation.take_warnings();
        lock(&lock(&self.outbox).messages).extend(warnings.into_iter().map(Message::Note));
        let stepped = begun.elapsed();
        if steps > 0 {
            let per_step = stepped.as_secs_f64() / f64::from(steps);
            simulation.set_steps_at_once((BATCH / per_step.max(1e-7)) as u32);
        }
        if self.mouse_force.is_some() || self.grip.is_some() {
            self.watch.restart();
        } else {
            let (alarms, burst) = self.watch.examine(simulation).await?;
            let kind = if burst { Message::Failed } else { Message::Note };
            lock(&lock(&self.outbox).messages).extend(alarms.into_iter().map(|alarm| kind(alarm.message)));
            self.playing &= !burst;
        }
        self.meter.count(steps, f64::from(seconds), simulation).await?;
        // A new snapshot is only needed after the window has drawn the last one.
        let wanted = lock(&self.outbox).is_seen || !self.playing;
        let shown = if wanted { self.show().await } else { Ok(()) };
        self.pace.record(f64::from(seconds), stepped, begun.elapsed() - stepped);
        shown
    }

    /// Pauses the simulation and reports the error.
    fn fail(&mut self, error: &SimulationError) {
        self.playing = false;
        lock(&lock(&self.outbox).messages).push(Message::Failed(error.to_string()));
        (self.repaint)();
    }
}
