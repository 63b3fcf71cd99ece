//! Compares surface reconstruction with splashsurf.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};

use super::numbers::{median, number};
use super::table::{Table, at_least, at_most};
use super::{Sides, answer};
use crate::process::{command, root, run, say};
use crate::report::Page;

/// Required speed relative to splashsurf, and allowed memory relative to splashsurf.
const SPEED_BAR: f64 = 1.5;
const MEMORY_BAR: f64 = 1.0;

/// Reconstructions per process; their median is reported.
const REPETITIONS: usize = 5;

/// An optional data set beside the repository, particles of a dam break in mid-splash, and its spacing.
const SHARED: (&str, f64) = ("../shared/data/particles/mid64k.npy", 0.05);

/// Cell sizes in particle radii, and numbers of smoothing iterations.
const CASES: [(f64, u32); 4] = [(1.0, 0), (1.0, 25), (0.5, 0), (0.5, 25)];

/// Adds the section of the page.
pub fn compare(sides: &Sides, given: Option<(PathBuf, f64)>, page: &mut Page) -> Result<()> {
    let (particles, spacing) = particles(sides, given)?;
    let xyz = sides.folder.join("particles.xyz");
    let converted = answer(command(&sides.python).arg(script()).arg("convert").args([&particles, &xyz]))?;
    let count = number(&converted, "particles")?;
    let mut table = Table::new(&[
        "cells, smoothing",
        "vertices, ours / theirs",
        "ms, ours / theirs",
        "k particles/s, ours / theirs",
        "speed, ours over theirs",
        "memory in MB, ours / theirs",
        "memory, ours over theirs",
    ]);
    for (cell, smoothing) in CASES {
        say(format!("Surface, cells of {cell} r, {smoothing} rounds of smoothing ..."));
        let case = Case { sides, particles: &particles, xyz: &xyz, radius: spacing / 2.0, cell, smoothing };
        let [mut ours, mut theirs] = [const { Vec::new() }; 2];
        let [mut our_vertices, mut their_vertices] = [0.0; 2];
        for _ in 0..sides.rounds {
            let answer = case.ours(REPETITIONS)?;
            ours.push(median(&answer.seconds));
            our_vertices = answer.vertices;
            let answer = case.theirs()?;
            theirs.push(number(&answer, "seconds")?);
            their_vertices = number(&answer, "vertices")?;
        }
        let memory = [case.ours(1)?.memory, case.their_memory()?];
        let seconds = [median(&ours), median(&theirs)];
        let pair =
            |values: [f64; 2], digits: usize| format!("{:.digits$} / {:.digits$}", values[0], values[1]);
        table.row(&[
            format!(
                "{cell:.1} r, {}",
                if smoothing == 0 { "plain".into() } else { format!("{smoothing} rounds") }
            ),
            pair([our_vertices, their_vertices], 0),
            pair(seconds.map(|seconds| 1e3 * seconds), 1),
            pair(seconds.map(|seconds| 1e-3 * count / seconds), 0),
            at_least(seconds[1] / seconds[0], SPEED_BAR),
            pair(memory.map(|bytes| 1e-6 * bytes), 1),
            at_most(memory[0] / memory[1], MEMORY_BAR),
        ]);
    }
    page.add("## Surface reconstruction");
    page.add_anchored("surface", table.text());
    let name = particles.file_name().unwrap_or_default().to_string_lossy();
    page.add(&format!(
        "Particles: `{name}`, {count} of them, radius r = {} m. Support four radii (smoothing length 2.0), threshold 0.6. Smoothed cases include \
         weights and normals, and splashsurf's mesh clean-up, which removes vertices; Splashdown needs no clean-up. Times are from \
         particles in memory to the mesh in memory, the median of {REPETITIONS} in one process. Memory is the peak of a process that \
         reads the particles and writes one mesh as PLY, minus the memory in use before the particles are read: for Splashdown that of \
         `splashdown surface`, for splashsurf that of its command line in Python.",
        spacing / 2.0
    ));
    Ok(())
}

fn script() -> PathBuf {
    root().join("xtask/peers/splashsurf.py")
}

/// The given particles, those beside the repository, or the built-in dam break after 0.3 s.
fn particles(sides: &Sides, given: Option<(PathBuf, f64)>) -> Result<(PathBuf, f64)> {
    if let Some((path, spacing)) = given {
        // Relative to the user's working directory; other programs start in the root of the repository.
        return Ok((std::path::absolute(path)?, spacing));
    }
    let shared = root().join(SHARED.0);
    if shared.exists() {
        return Ok((shared, SHARED.1));
    }
    say(format!(
        "NOTE: {} does not exist; the built-in dam break is used. To use other particles: --particles FILE SPACING",
        SHARED.0
    ));
    let out = sides.folder.join("dam-break");
    let mut simulate = command(&sides.ours);
    simulate.args(["run", "dam-break", "--frames", "9", "--no-surface", "--no-pictures", "--quiet"]);
    run(simulate.args(["--formats", "npz", "--out"]).arg(&out))?;
    let path = out.join("particles/particles_0009.npz");
    ensure!(path.exists(), "the run succeeded, but {} does not exist", path.display());
    Ok((path, 0.015_625))
}

/// One row of the table.
struct Case<'a> {
    sides: &'a Sides,
    particles: &'a Path,
    xyz: &'a Path,
    radius: f64,
    cell: f64,
    smoothing: u32,
}

/// The result of Splashdown.
struct Answer {
    seconds: Vec<f64>,
    vertices: f64,
    memory: f64,
}

impl Case<'_> {
    /// Reconstructs the surface `repetitions` times in one process.
    fn ours(&self, repetitions: usize) -> Result<Answer> {
        let mut surface = command(&self.sides.ours);
        surface.arg("surface");
        let ending = self.particles.extension().unwrap_or_default().to_string_lossy();
        for repetition in 0..repetitions {
            // A file that is given twice is read once.
            let copy = self.sides.folder.join(format!("particles_{repetition}.{ending}"));
            fs::copy(self.particles, &copy)?;
            surface.arg(copy);
        }
        let meshes = self.sides.folder.join("mesh_*.ply");
        surface.arg("--out").arg(meshes).args(["--device", "cpu", "--json", "--quiet", "--force"]);
        surface.args(["--particle-spacing", &(2.0 * self.radius).to_string()]);
        surface.args(["--cell-size", &(self.cell * self.radius).to_string()]);
        surface.args(["--smoothing", &self.smoothing.to_string()]);
        surface.env("RAYON_NUM_THREADS", self.sides.threads.to_string());
        let output = surface.output()?;
        let text = String::from_utf8_lossy(&output.stdout);
        ensure!(output.status.success(), "splashdown surface: {}", String::from_utf8_lossy(&output.stderr));
        let seconds = text.lines().map(|line| number(line, "surface_seconds")).collect::<Result<Vec<_>>>()?;
        let last = text.lines().last().context("splashdown surface printed nothing")?;
        let memory = number(last, "peak_memory")? - number(last, "start_memory")?;
        Ok(Answer { seconds, vertices: number(last, "vertices")?, memory })
    }

    /// The same with splashsurf.
    fn theirs(&self) -> Result<String> {
        let mut peer = self.peer("time", self.particles);
        answer(peer.arg(REPETITIONS.to_string()))
    }

    fn their_memory(&self) -> Result<f64> {
        let json = answer(&mut self.peer("memory", self.xyz))?;
        Ok(number(&json, "peak_memory")? - number(&json, "start_memory")?)
    }

    fn peer(&self, word: &str, particles: &Path) -> std::process::Command {
        let mut peer = command(&self.sides.python);
        peer.arg(script()).arg(word).arg(particles);
        peer.args([self.radius.to_string(), self.cell.to_string(), self.smoothing.to_string()]);
        peer.env("RAYON_NUM_THREADS", self.sides.threads.to_string());
        peer
    }
}
