//! Playing a finished run: its frames in place of the snapshots of the engine.

use std::path::PathBuf;
use std::sync::Arc;

use egui::Context;
use splashdown::Stats;
use splashdown_gpu::Timings;
use splashdown_run::{PlayedFrame, RunFrames};

use super::Viewer;
use crate::engine::{Command, Drawn, Opened, Snapshot};
use crate::look::{DisplayMode, Look};
use crate::playback::{MEMORY, Playback};

/// A run that is played, and the frame that is shown.
pub(super) struct Player {
    playback: Playback,
    opened: Option<Arc<Opened>>,
    shown: Option<(u32, Arc<Snapshot>)>,
}

impl Viewer {
    /// Plays a run in place of the simulation.
    ///
    /// # Errors
    /// As [`Playback::start`].
    pub(crate) fn play(&mut self, run: RunFrames, ctx: &Context) -> Result<(), String> {
        let repaint = ctx.clone();
        let scene = run.scene().clone();
        let (playback, timeline, problem) = Playback::start(run, MEMORY, move || repaint.request_repaint())?;
        self.end_recording();
        self.stop_simulation();
        self.state.open(scene);
        self.state.playing = false;
        if !timeline.has_particles && self.state.look.mode.needs_particles() {
            self.state.look.mode = DisplayMode::Surface;
        } else if !timeline.has_meshes && self.state.look.mode.needs_surface() {
            self.state.look.mode = DisplayMode::Smooth;
        }
        self.state.timeline = Some(timeline);
        self.player = Some(Player { playback, opened: None, shown: None });
        if let Some(problem) = problem {
            self.state.notify(problem, true, ctx.input(|input| input.time));
        }
        Ok(())
    }

    /// Advances the position and uploads the frame to show.
    pub(super) fn update_player(&mut self, ctx: &Context) {
        let (Some(player), Some(timeline)) = (&mut self.player, &mut self.state.timeline) else { return };
        let now = ctx.input(|input| input.time);
        let mut messages = player.playback.update(timeline);
        timeline.tick(now, player.playback.frame(timeline.current()).is_some());
        let number = timeline.current();
        if player.shown.as_ref().is_none_or(|(shown, _)| *shown != number)
            && let Some(frame) = player.playback.frame(number)
        {
            match player.snapshot(&self.gpu.device, self.gpu.name(), &frame) {
                Ok(snapshot) => {
                    let figures = &mut self.state.figures;
                    figures.time = frame.time;
                    figures.particles = snapshot.stats.particles;
                    figures.triangles = snapshot.drawn.mesh().map(|mesh| mesh.stats.triangles);
                    player.shown = Some((number, snapshot));
                }
                Err(reason) => {
                    timeline.leave_out(number);
                    messages.push(format!("frame {number} is left out: {reason}"));
                }
            }
        }
        if timeline.playing {
            ctx.request_repaint_after(std::time::Duration::from_secs_f64(timeline.until_next().min(0.5)));
        }
        for message in messages {
            self.state.notify(message, true, now);
        }
    }

    /// The folder of the run that is played.
    pub(super) fn played_folder(&self) -> Option<PathBuf> {
        self.player.as_ref().map(|player| player.playback.run().folder().to_owned())
    }

    fn stop_simulation(&mut self) {
        self.engine.send(Command::MouseForce(None));
        self.engine.send(Command::Play(false));
    }
}

impl Player {
    /// The frame that is shown, and the display settings for it: a frame without the particles that the mode needs is
    /// shown by its mesh.
    pub fn shown(&self, mut look: Look) -> Option<(Arc<Snapshot>, Look)> {
        let (_, snapshot) = self.shown.as_ref()?;
        let mesh_only = snapshot.stats.particles == 0 && snapshot.drawn.mesh().is_some();
        if mesh_only && look.mode.needs_particles() {
            look.mode = DisplayMode::Surface;
        }
        Some((Arc::clone(snapshot), look))
    }

    /// Copies a frame to the device.
    fn snapshot(
        &mut self,
        device: &wgpu::Device,
        name: String,
        frame: &PlayedFrame,
    ) -> Result<Arc<Snapshot>, String> {
        let drawn = Drawn::of_frame(device, frame).map_err(|error| error.to_string())?;
        let opened = self.opened.get_or_insert_with(|| {
            Arc::new(Opened {
                scene: self.playback.run().scene().clone(),
                bodies: self.playback.bodies().unwrap_or_default(),
                device: name,
                memory: 0,
            })
        });
        let mut stats = Stats::default();
        stats.time = frame.time;
        stats.particles = frame.particles.as_ref().map_or(0, |particles| particles.len() as u32);
        Ok(Arc::new(Snapshot {
            opened: Arc::clone(opened),
            stats,
            drawn: Arc::new(drawn),
            bodies: frame.bodies.clone(),
            mean_height: f32::NAN,
            steps_per_second: 0.0,
            speed: 0.0,
            timings: Arc::new(Timings::default()),
            timed_steps: 0,
            playing: false,
        }))
    }
}
