//! `run.json`: the summary of a run in its output folder, for other programs and for later reference.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;
use splashdown::Stats;
use splashdown::monitor::{EnergyBalance, Level};
use splashdown::run::Summary;
use splashdown::scene::Scene;
use splashdown_gpu::Timings;
use splashdown_io::{IoError, atomic};

use crate::settings::Notes;
use crate::{RunFolder, RunSettings};

/// The content of `run.json`.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Report {
    /// `running`, `finished`, `interrupted` or `failed`.
    pub status: &'static str,
    /// Version of the program.
    pub version: &'static str,
    /// The scene's name.
    pub scene: String,
    /// The scene's file as it was given; null for a built-in scene.
    pub file: Option<String>,
    /// The absolute path of that file, from whose folder the scene names its meshes and other files; null if it is not
    /// UTF-8.
    pub scene_path: Option<String>,
    /// The text of the scene. With it a folder can be drawn and played after the scene file has changed.
    pub scene_text: String,
    /// The settings that changed the scene.
    pub settings: Notes,
    /// The device's name.
    pub device: Option<String>,
    /// Particle spacing in m.
    pub particle_spacing: f32,
    /// Frames per second.
    pub frame_rate: f32,
    /// Gravity in m/s^2.
    pub gravity: [f32; 3],
    /// The names of the bodies.
    pub bodies: Vec<String>,
    /// Frames with complete files, including the initial one.
    pub complete_frames: usize,
    /// The end of the simulation.
    pub end: Option<End>,
    /// Speed and quality of a finished run.
    pub summary: Option<Numbers>,
    /// Time per pass, if it was measured.
    pub passes: BTreeMap<&'static str, PassNumbers>,
    /// Time per pass of the pictures, if it was measured.
    pub picture_passes: BTreeMap<&'static str, PassNumbers>,
    /// Files written.
    pub files: usize,
    /// Their size in bytes.
    pub bytes: u64,
    /// Why the run failed.
    pub error: Option<String>,
    /// The findings of the monitor.
    pub monitor: Monitored,
}

/// The findings of the monitor.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Monitored {
    /// The highest level: `sound`, `note`, `warning` or `stop`.
    pub level: Level,
    /// The energy balance of the last frame in J.
    pub energy: EnergyBalance,
    /// Every rise of a watched quantity to a new level, with those of earlier parts of a resumed run.
    pub alarms: Vec<serde_json::Value>,
}

/// The last state.
#[derive(Debug, Serialize)]
pub(crate) struct End {
    time: f64,
    steps: u64,
    dt: f32,
    particles: u32,
    emitted: u32,
    drained: u32,
    escaped: u32,
    inside_bodies: u32,
    non_finite: u32,
    wall_corrections: u32,
    max_speed: f32,
    density_error: f32,
    density_excess: f32,
    density_deficit: f32,
}

/// The whole run in a few numbers.
#[derive(Debug, Serialize)]
pub(crate) struct Numbers {
    frames: u32,
    wall: f64,
    step_wall: f64,
    frame_wall: f64,
    monitor_wall: f64,
    particle_steps_per_second: f64,
    simulated_per_wall: f64,
    density_error: f32,
    density_excess: f32,
    density_deficit: f32,
    surface_volume: Option<[f64; 2]>,
    particle_volume: [f64; 2],
    /// Of an implicit pressure.
    pressure: Option<PressureNumbers>,
}

/// An implicit pressure: errors of the density are parts of the rest density.
#[derive(Debug, Serialize)]
struct PressureNumbers {
    iterations: u64,
    tolerance: f32,
    residual: f32,
    mean_compression: f64,
    unconverged: u32,
}

/// How often a pass ran, and its total time.
#[derive(Debug, Serialize)]
pub struct PassNumbers {
    count: u64,
    seconds: f64,
}

/// An unknown working directory leaves the path as it was given.
fn absolute(path: &Path) -> Option<String> {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    path.into_os_string().into_string().ok()
}

impl Report {
    /// The report of a run that starts.
    pub fn new(scene: &Scene, settings: &RunSettings) -> Self {
        Self {
            status: "running",
            version: env!("CARGO_PKG_VERSION"),
            scene: scene.name.clone(),
            file: scene.source.as_ref().map(|path| path.display().to_string()),
            scene_path: scene.source.as_deref().and_then(absolute),
            scene_text: scene.text.to_string(),
            settings: Notes::new(settings),
            particle_spacing: scene.fluid.particle_spacing,
            frame_rate: scene.frame_rate,
            gravity: scene.gravity.to_array(),
            bodies: scene.bodies.iter().map(|body| body.name.clone()).collect(),
            ..Self::default()
        }
    }

    /// Sets the last state.
    pub fn set_end(&mut self, stats: &Stats) {
        self.end = Some(End {
            time: stats.time,
            steps: stats.steps,
            dt: stats.dt,
            particles: stats.particles,
            emitted: stats.emitted,
            drained: stats.drained,
            escaped: stats.escaped,
            inside_bodies: stats.inside_bodies,
            non_finite: stats.non_finite,
            wall_corrections: stats.wall_corrections,
            max_speed: stats.max_speed,
            density_error: stats.density_error,
            density_excess: stats.density_excess,
            density_deficit: stats.density_deficit,
        });
    }

    /// Sets the summary of a finished run.
    pub fn set_summary(&mut self, summary: &Summary) {
        self.set_end(&summary.stats);
        self.passes = pass_numbers(&summary.timings);
        self.summary = Some(Numbers {
            frames: summary.frames,
            wall: summary.wall,
            step_wall: summary.step_wall,
            frame_wall: summary.frame_wall,
            monitor_wall: summary.monitor_wall,
            particle_steps_per_second: summary.particle_steps_per_second,
            simulated_per_wall: summary.simulated_per_wall,
            density_error: summary.density_error(),
            density_excess: summary.density_excess,
            density_deficit: summary.density_deficit,
            surface_volume: summary.volume,
            particle_volume: summary.particle_volume,
            pressure: summary.tolerance.map(|tolerance| PressureNumbers {
                iterations: summary.stats.iterations,
                tolerance,
                residual: summary.residual,
                mean_compression: summary.stats.mean_compression,
                unconverged: summary.stats.unconverged,
            }),
        });
    }

    /// Writes the file. It is complete or absent.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn write(&self, folder: &RunFolder) -> Result<(), IoError> {
        let fill = |out: &mut dyn std::io::Write| {
            serde_json::to_writer_pretty(&mut *out, self)?;
            out.write_all(b"\n")
        };
        atomic::write(&folder.report(), fill).map(|_| ())
    }
}

/// Whether the folder contains the report of a finished run.
pub(crate) fn is_finished(folder: &RunFolder) -> bool {
    earlier(folder).is_some_and(|report| report["status"] == "finished")
}

/// The alarms in the report of an earlier part of the run, up to a simulated time in s.
pub(crate) fn alarms_until(folder: &RunFolder, time: f64) -> Vec<serde_json::Value> {
    let Some(mut report) = earlier(folder) else { return Vec::new() };
    let serde_json::Value::Array(mut alarms) = report["monitor"]["alarms"].take() else { return Vec::new() };
    alarms.retain(|alarm| alarm["time"].as_f64().is_some_and(|at| at <= time));
    alarms
}

/// The report in the folder, if there is one.
fn earlier(folder: &RunFolder) -> Option<serde_json::Value> {
    let bytes = folder.report().is_file().then(|| std::fs::read(folder.report()).ok()).flatten()?;
    serde_json::from_slice(&bytes).ok()
}

/// The times of the passes as plain numbers.
pub fn pass_numbers(timings: &Timings) -> BTreeMap<&'static str, PassNumbers> {
    let numbers = |time: &splashdown_gpu::PassTime| PassNumbers {
        count: time.count,
        seconds: time.total.as_secs_f64(),
    };
    timings.passes.iter().map(|(&label, time)| (label, numbers(time))).collect()
}

#[cfg(all(test, unix))]
mod tests {
    use super::absolute;
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    use std::path::Path;

    /// JSON has no other texts; such a path must not make the report, and with it the run, fail.
    #[test]
    fn paths_that_are_not_utf_8_are_left_out() {
        assert_eq!(absolute(Path::new("/a/b.toml")).as_deref(), Some("/a/b.toml"));
        assert_eq!(absolute(Path::new(OsStr::from_bytes(b"/a/\xff.toml"))), None);
    }
}
