//! USD, the scene format of film and animation, as text (`.usda`): all frames of a run in one file, as time samples.
//!
//! Blender, Houdini, Maya, `usdview` and Omniverse open it. [`MeshSeries`] is the animated surface, [`PointSeries`] the
//! particles. Velocities are the attribute `velocities`, which these programs use for motion blur.
//!
//! *How it works.* The file contains all frames of one attribute before the next attribute, so a frame cannot be
//! appended to it. Each attribute has a hidden temporary file (`spool`), to which frames are appended;
//! [`MeshSeries::finish`] joins these files. A run that is killed leaves no USD file; one that ends normally or by
//! Ctrl-C leaves a complete one.
//!
//! *Why own code:* the text has five kinds of lines. The crate `openusd` 0.8 is new and needs a newer compiler; the C++
//! library takes an hour to build. `tests/foreign` opens the files with Pixar's library. *Why text:* the binary form
//! (`usdc`), with about a third of the size, is documented only by the source of that library.

mod spool;
mod text;

use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use self::spool::{Attribute, Spool};
use crate::atomic;
use crate::data::Mesh;
use crate::data::Particles;
use crate::error::IoError;

/// Attributes of a mesh, in the order of [`MeshSeries::push`].
const MESH: [Attribute; 6] = [
    Attribute { declaration: "float3[] extent", interpolation: None },
    Attribute { declaration: "int[] faceVertexCounts", interpolation: None },
    Attribute { declaration: "int[] faceVertexIndices", interpolation: None },
    Attribute { declaration: "point3f[] points", interpolation: None },
    Attribute { declaration: "normal3f[] normals", interpolation: Some("vertex") },
    Attribute { declaration: "vector3f[] velocities", interpolation: None },
];

/// Attributes of particles, in the order of [`PointSeries::push`].
const POINTS: [Attribute; 6] = [
    Attribute { declaration: "float3[] extent", interpolation: None },
    Attribute { declaration: "point3f[] points", interpolation: None },
    Attribute { declaration: "vector3f[] velocities", interpolation: None },
    Attribute { declaration: "int64[] ids", interpolation: None },
    Attribute { declaration: "float[] primvars:density", interpolation: Some("vertex") },
    Attribute { declaration: "float[] primvars:pressure", interpolation: Some("vertex") },
];

/// The animated surface: one mesh whose points and triangles change from frame to frame.
#[derive(Debug)]
pub struct MeshSeries(Series);

/// The animated particles.
#[derive(Debug)]
pub struct PointSeries(Series);

impl MeshSeries {
    /// Begins a series. [`MeshSeries::finish`] creates the file.
    ///
    /// # Errors
    /// [`IoError::Write`] if its folder is not writable.
    pub fn start(path: &Path, frames_per_second: f64) -> Result<Self, IoError> {
        let head =
            "def Mesh \"surface\"\n    {\n        uniform token subdivisionScheme = \"none\"\n        \
                    uniform token orientation = \"rightHanded\"\n"
                .to_owned();
        Series::start(path, frames_per_second, head, &MESH).map(Self)
    }

    /// Appends the mesh of a frame. Frames must be appended in the order of their numbers.
    ///
    /// # Errors
    /// Those of [`Mesh::check`]; [`IoError::Write`].
    pub fn push(&self, frame: u32, mesh: &Mesh) -> Result<(), IoError> {
        mesh.check()?;
        self.0.push(frame, |spools| {
            let [extent, counts, corners, points, normals, velocities] = spools else { return Ok(()) };
            extent.vectors(frame, &text::extent(&mesh.vertices), true)?;
            counts.integers(frame, std::iter::repeat_n(3, mesh.len()), true)?;
            corners.integers(frame, mesh.triangles.as_flattened().iter().copied(), true)?;
            points.vectors(frame, &mesh.vertices, true)?;
            normals.vectors(frame, &mesh.normals, !mesh.normals.is_empty())?;
            velocities.vectors(frame, &mesh.velocities, !mesh.velocities.is_empty())
        })
    }

    /// Writes the file; returns its path and size in bytes, or `None` if there are no frames. A second call does nothing
    /// and returns `None`.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn finish(&self) -> Result<Option<(PathBuf, u64)>, IoError> {
        self.0.finish()
    }
}

impl PointSeries {
    /// Begins a series of particles, which are shown as spheres of this diameter in m.
    ///
    /// # Errors
    /// [`IoError::Write`] if its folder is not writable.
    pub fn start(path: &Path, frames_per_second: f64, diameter: f32) -> Result<Self, IoError> {
        let head = format!(
            "def Points \"particles\"\n    {{\n        float[] widths = [{diameter}] (\n            interpolation = \
             \"constant\"\n        )\n"
        );
        Series::start(path, frames_per_second, head, &POINTS).map(Self)
    }

    /// Appends the particles of a frame. Frames must be appended in the order of their numbers.
    ///
    /// # Errors
    /// Those of [`Particles::check`]; [`IoError::Write`].
    pub fn push(&self, frame: u32, particles: &Particles) -> Result<(), IoError> {
        particles.check()?;
        self.0.push(frame, |spools| {
            let [extent, points, velocities, ids, densities, pressures] = spools else { return Ok(()) };
            extent.vectors(frame, &text::extent(&particles.positions), true)?;
            points.vectors(frame, &particles.positions, true)?;
            velocities.vectors(frame, &particles.velocities, !particles.velocities.is_empty())?;
            ids.integers(frame, particles.ids.iter().copied(), !particles.ids.is_empty())?;
            densities.numbers(frame, &particles.densities, !particles.densities.is_empty())?;
            pressures.numbers(frame, &particles.pressures, !particles.pressures.is_empty())
        })
    }

    /// Like [`MeshSeries::finish`].
    ///
    /// # Errors
    /// Those of [`MeshSeries::finish`].
    pub fn finish(&self) -> Result<Option<(PathBuf, u64)>, IoError> {
        self.0.finish()
    }
}

/// A prim with its samples so far.
#[derive(Debug)]
struct Series {
    path: PathBuf,
    frames_per_second: f64,
    /// The beginning of the prim, with attributes that are constant in time.
    head: String,
    state: Mutex<State>,
}

#[derive(Debug)]
struct State {
    spools: Vec<Spool>,
    /// Numbers of the first and the last frame.
    frames: Option<[u32; 2]>,
}

impl Series {
    fn start(
        path: &Path,
        frames_per_second: f64,
        head: String,
        attributes: &'static [Attribute],
    ) -> Result<Self, IoError> {
        let spools: io::Result<Vec<Spool>> =
            attributes.iter().map(|attribute| Spool::create(path, attribute)).collect();
        let spools = spools.map_err(|error| IoError::write(path, &error))?;
        let state = Mutex::new(State { spools, frames: None });
        Ok(Self { path: path.to_owned(), frames_per_second, head, state })
    }

    fn push(&self, frame: u32, append: impl FnOnce(&mut [Spool]) -> io::Result<()>) -> Result<(), IoError> {
        let mut state = self.state();
        append(&mut state.spools).map_err(|error| IoError::write(&self.path, &error))?;
        let first = state.frames.map_or(frame, |[first, _]| first);
        state.frames = Some([first, frame]);
        Ok(())
    }

    fn finish(&self) -> Result<Option<(PathBuf, u64)>, IoError> {
        // The state is taken, so that the hidden files are removed even on failure.
        let State { spools, frames } =
            std::mem::replace(&mut *self.state(), State { spools: Vec::new(), frames: None });
        let Some([first, last]) = frames else { return Ok(None) };
        let bytes = atomic::write(&self.path, |out| {
            write!(
                out,
                "#usda 1.0\n(\n    defaultPrim = \"splashdown\"\n    doc = \"written by Splashdown; SI units\"\n    \
                 endTimeCode = {last}\n    framesPerSecond = {fps}\n    metersPerUnit = 1\n    startTimeCode = {first}\n    \
                 timeCodesPerSecond = {fps}\n    upAxis = \"Y\"\n)\n\ndef Xform \"splashdown\"\n{{\n    {}",
                self.head,
                fps = self.frames_per_second,
            )?;
            write!(
                out,
                "        color3f[] primvars:displayColor = [(0.2, 0.45, 0.6)] (\n            interpolation = \"constant\"\n        \
                 )\n"
            )?;
            for spool in spools {
                spool.write_to(out)?;
            }
            writeln!(out, "    }}\n}}")
        })?;
        Ok(Some((self.path.clone(), bytes)))
    }

    /// Ignores the panic of another thread that held the lock.
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
