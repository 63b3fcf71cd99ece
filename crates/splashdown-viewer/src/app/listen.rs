//! Receiving messages of the engine, and requesting the data to display.

use std::sync::Arc;

use egui::Context;
use glam::Vec3;
use splashdown::Checkpoint;
use splashdown_gpu::GpuError;

use super::Viewer;
use crate::engine::{Command, Message, Purpose};
use crate::state::Tool;
use crate::{export, pick};

impl Viewer {
    /// Requests the data that the display mode needs.
    pub(super) fn request_displayed_data(&mut self) {
        let surface = self.state.look.mode.needs_surface();
        if std::mem::replace(&mut self.requested.wants_surface, surface) != surface {
            self.engine.send(Command::Surface(surface));
        }
        let timing = self.state.shown.timings;
        if std::mem::replace(&mut self.requested.wants_timing, timing) != timing {
            self.engine.send(Command::Timing(timing));
        }
        let times = self.picture.time_passes(timing);
        self.state.figures.drawing = times.iter().map(|pass| (pass.label, pass.milliseconds)).collect();
    }

    /// Receives the messages and the newest snapshot of the engine.
    pub(super) fn listen(&mut self, ctx: &Context) {
        let now = ctx.input(|input| input.time);
        for message in self.engine.take_messages() {
            match message {
                Message::Note(text) => self.state.notify(text, false, now),
                Message::Failed(text) => {
                    self.state.playing = false;
                    self.state.preparing = None;
                    self.revert_edits();
                    self.state.notify(text, true, now);
                }
                Message::Refused(text) => {
                    self.revert_edits();
                    self.state.notify(text, true, now);
                }
                Message::Stopped => {
                    self.state.playing = false;
                    let text = "the simulation ended because of a bug in this program; restart the program";
                    self.state.notify(text, true, now);
                }
                Message::Checkpoint(checkpoint, Purpose::Export) => {
                    let name = format!("{}.{}", self.state.scene.name, Checkpoint::ENDING);
                    let exported = export::checkpoint(&name, &checkpoint);
                    self.report_export("the checkpoint", exported, now);
                }
                Message::Checkpoint(checkpoint, Purpose::Rescue) => self.rescue = Some(checkpoint),
                Message::Preparing(body, part) => self.state.preparing = (part < 1.0).then_some((body, part)),
                Message::Exported(mesh) => {
                    if std::mem::take(&mut self.requested.exporting) {
                        let name = format!("{}.ply", self.state.scene.name);
                        let exported = export::mesh(&name, &mesh);
                        self.report_export("the surface", exported, now);
                    }
                }
            }
        }
        if let Err(error) = self.gpu.health("the window") {
            self.state.notify(error.to_string(), true, now);
            if matches!(error, GpuError::DeviceLost { .. })
                && !std::mem::replace(&mut self.state.figures.lost, true)
            {
                self.save_rescue(now);
            }
        }
        // A run that is played has its own figures.
        let Some(snapshot) = self.engine.snapshot().filter(|_| self.state.timeline.is_none()) else { return };
        let figures = &mut self.state.figures;
        figures.steps_per_second = snapshot.steps_per_second;
        figures.speed = snapshot.speed;
        figures.time = snapshot.stats.time;
        figures.playing = snapshot.playing;
        figures.dt = snapshot.stats.dt;
        figures.particles = snapshot.stats.particles;
        figures.density_error = snapshot.stats.density_error;
        figures.iterations = snapshot.stats.iterations as f64 / snapshot.stats.steps.max(1) as f64;
        figures.compression = snapshot.stats.compression;
        figures.residual = snapshot.stats.residual;
        figures.viscous_iterations =
            snapshot.stats.viscous_iterations as f64 / snapshot.stats.steps.max(1) as f64;
        figures.triangles = snapshot.drawn.mesh().map(|mesh| mesh.stats.triangles);
        figures.timings = Arc::clone(&snapshot.timings);
        figures.timed_steps = snapshot.timed_steps;
        figures.mean_height = snapshot.mean_height;
        figures.memory = snapshot.opened.memory;
        figures.device.clone_from(&snapshot.opened.device);
        if self.state.tool == Tool::Edit && snapshot.stats.time == 0.0 {
            self.state.body_bounds = pick::bounds(&snapshot.opened, &snapshot.bodies);
        }
    }

    /// Replaces the scene with changes by the scene being simulated. That of a run that is played has no changes.
    fn revert_edits(&mut self) {
        if let Some(snapshot) = self.engine.snapshot().filter(|_| self.state.timeline.is_none()) {
            self.state.scene = snapshot.opened.scene.clone();
            self.state.history.forget_repeated(&self.state.scene);
            self.state.count();
        }
    }

    /// Grabs the dynamic body that the ray hits first, if any.
    pub(super) fn grab(&mut self, ray: (Vec3, Vec3)) {
        let Some(snapshot) = self.engine.snapshot() else { return };
        if let Some((grip, distance)) = pick::body(&snapshot.opened, &snapshot.bodies, ray) {
            self.state.grip = Some((grip, distance));
            self.engine.send(Command::Grip(Some(grip)));
        }
    }
}
