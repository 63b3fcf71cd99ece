//! The lines of `splashdown run --json`: one object each, all with the same keys.

use serde::Serialize;
use splashdown::Stats;
use splashdown::run::{Progress, Started, Summary};
use splashdown::scene::SceneProblem;
use splashdown_run::CompleteFrame;

use crate::exit::Failure;

/// One line. The first eleven keys are always present, and null if unknown. The other keys are omitted if they do not
/// apply.
#[derive(Debug, Default, Serialize)]
pub struct Line {
    /// started, progress, frame, warning, finished, interrupted or error.
    pub event: &'static str,
    /// Number of the frame, from 0.
    pub frame: Option<u32>,
    /// Simulated time in s.
    pub time: Option<f64>,
    /// Steps since the start.
    pub steps: Option<u64>,
    /// The largest stable time step in s.
    pub dt: Option<f32>,
    /// Particles inside the domain.
    pub particles: Option<u32>,
    /// The larger one of relative excess and deficit of density, or the largest of the whole run at its end.
    pub density_error: Option<f32>,
    /// The largest speed in m/s.
    pub max_speed: Option<f32>,
    /// Volume inside the surface and of the droplets in m^3.
    pub volume: Option<f64>,
    /// Triangles of the surface.
    pub triangles: Option<usize>,
    /// Complete files.
    pub files: Option<Vec<String>>,
    /// Isolated particles, which are not part of the surface.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub droplets: Option<usize>,
    /// Number of frames of the run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frames: Option<u32>,
    /// Wall time since the start in s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wall: Option<f64>,
    /// Simulated seconds per second of wall time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub simulated_per_wall: Option<f64>,
    /// Particles times steps per second.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub particle_steps_per_second: Option<f64>,
    /// Pressure iterations since the start.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub iterations: Option<u64>,
    /// The mean residual of the density at which the pressure iterations stop; in the first and the last line.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f32>,
    /// The largest mean residual of the density at which the iterations of a step since the last frame stopped, or of the whole
    /// run at its end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub residual: Option<f32>,
    /// Mean compression since the last frame, or of the whole run at its end, from the positions of the particles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub compression: Option<f64>,
    /// Steps whose pressure did not converge, since the start.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unconverged: Option<u32>,
    /// Viscosity iterations since the start.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub viscous_iterations: Option<u64>,
    /// The largest residual of the velocity at which the viscosity iterations of a step since the last frame stopped, as a
    /// part of the change of the velocity by all other forces.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub viscous_residual: Option<f32>,
    /// Steps whose viscosity did not converge, since the start.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub viscous_unconverged: Option<u32>,
    /// The relative excess of density that one particle in a hundred has, or the largest of the whole run at its end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub density_excess: Option<f32>,
    /// The relative deficit of density that one inner particle in a hundred has, or the largest of the whole run at its end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub density_deficit: Option<f32>,
    /// Total number of particles that left through an open side.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub escaped: Option<u32>,
    /// Total number of particles that became NaN or infinite.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub non_finite: Option<u32>,
    /// The device's name.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub device: Option<String>,
    /// Bytes in the device's buffers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub memory: Option<u64>,
    /// Text for people.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub message: Option<String>,
    /// The exit code.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exit_code: Option<u8>,
    /// Every problem of the scene file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub problems: Option<Vec<SceneProblem>>,
}

impl Line {
    /// The first line.
    pub fn started(started: &Started) -> Self {
        Self {
            event: "started",
            particles: Some(started.particles),
            frames: Some(started.frames),
            dt: Some(started.dt),
            tolerance: started.tolerance,
            frame: Some(started.first_frame),
            time: Some(started.time),
            steps: Some(started.steps),
            device: Some(started.device.clone()),
            memory: Some(started.memory),
            ..Self::default()
        }
    }

    /// The progress between two frames.
    pub fn progress(progress: &Progress) -> Self {
        Self {
            event: "progress",
            frame: Some(progress.frame),
            frames: Some(progress.frames),
            time: Some(progress.time),
            steps: Some(progress.steps),
            dt: Some(progress.dt),
            wall: Some(progress.wall.as_secs_f64()),
            ..Self::default()
        }
    }

    /// A frame and its files.
    pub fn frame(frame: &CompleteFrame) -> Self {
        Self {
            event: "frame",
            frame: Some(frame.summary.index),
            volume: frame.summary.volume,
            triangles: frame.summary.triangles,
            droplets: frame.summary.droplets,
            files: Some(frame.files.iter().map(|file| file.display().to_string()).collect()),
            ..Self::of_stats(&frame.summary.stats)
        }
    }

    /// A warning.
    pub fn warning(message: &str) -> Self {
        Self { event: "warning", message: Some(message.to_owned()), ..Self::default() }
    }

    /// The last line of a finished run.
    pub fn finished(summary: &Summary, triangles: Option<usize>, files: Vec<String>) -> Self {
        Self {
            event: "finished",
            frame: Some(summary.frames),
            frames: Some(summary.frames),
            density_error: Some(summary.density_error()),
            density_excess: Some(summary.density_excess),
            density_deficit: Some(summary.density_deficit),
            volume: summary.volume.map(|[_, last]| last),
            triangles,
            files: Some(files),
            wall: Some(summary.wall),
            simulated_per_wall: Some(summary.simulated_per_wall),
            particle_steps_per_second: Some(summary.particle_steps_per_second),
            tolerance: summary.tolerance,
            residual: summary.tolerance.map(|_| summary.residual),
            compression: (summary.stats.iterations > 0).then_some(summary.stats.mean_compression),
            ..Self::of_stats(&summary.stats)
        }
    }

    /// The last line of a run that was stopped.
    pub fn interrupted(last: Option<&CompleteFrame>, files: Vec<String>) -> Self {
        Self {
            event: "interrupted",
            files: Some(files),
            exit_code: Some(130),
            ..last.map(Self::frame).unwrap_or_default()
        }
    }

    /// The last line of a run that failed.
    pub fn error(failure: &Failure) -> Self {
        Self {
            event: "error",
            message: Some(failure.message.clone()),
            exit_code: Some(failure.exit as u8),
            problems: failure.scene.as_ref().map(|scene| scene.errors.clone()),
            ..Self::default()
        }
    }

    fn of_stats(stats: &Stats) -> Self {
        // An explicit pressure has no iterations.
        let implicit = (stats.iterations > 0).then_some(stats);
        let viscous = (stats.viscous_iterations > 0).then_some(stats);
        Self {
            time: Some(stats.time),
            steps: Some(stats.steps),
            dt: Some(stats.dt),
            particles: Some(stats.particles),
            density_error: Some(stats.density_error),
            density_excess: Some(stats.density_excess),
            density_deficit: Some(stats.density_deficit),
            max_speed: Some(stats.max_speed),
            escaped: Some(stats.escaped),
            non_finite: Some(stats.non_finite),
            iterations: implicit.map(|stats| stats.iterations),
            residual: implicit.map(|stats| stats.residual),
            compression: implicit.map(|stats| stats.compression.into()),
            unconverged: implicit.map(|stats| stats.unconverged),
            viscous_iterations: viscous.map(|stats| stats.viscous_iterations),
            viscous_residual: viscous.map(|stats| stats.viscous_residual),
            viscous_unconverged: viscous.map(|stats| stats.viscous_unconverged),
            ..Self::default()
        }
    }
}
