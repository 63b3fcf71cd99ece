//! USD, the scene format of film and animation, as text (`.usda`): a whole run in one file, with the frames as
//! time samples.
//!
//! Blender, Houdini, Maya, `usdview` and Omniverse open it; [`MeshSeries`] is the animated surface, [`PointSeries`] the
//! particles. Velocities are the attribute `velocities`, by which these programs blur motion.
//!
//! *How it works.* In such a file all frames of one attribute stand before the next attribute, so nothing can
//! be appended to it. Each attribute has a hidden file of its own beside the final one (`spool`), to which a
//! frame is appended, and [`MeshSeries::finish`] puts them together. A run that is killed leaves no USD file,
//! one that ends by itself or by Ctrl-C leaves a whole one.
//!
//! *Why own code:* text of five kinds of lines. The crate `openusd` 0.8 is young and wants a newer compiler;
//! the C++ library takes an hour to build. `tests/foreign.rs` opens the files with Pixar's own library. *Why
//! text:* the binary form (`usdc`) is described nowhere but in that library's source; it would take about a
//! third of the room.

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
    /// Begins a file; nothing of its name is there before [`MeshSeries::finish`].
    ///
    /// # Errors
    /// [`IoError::Write`] if nothing can be written beside it.
    pub fn start(path: &Path, frames_per_second: f64) -> Result<Self, IoError> {
        let head =
            "def Mesh \"surface\"\n    {\n        uniform token subdivisionScheme = \"none\"\n        \
                    uniform token orientation = \"rightHanded\"\n"
                .to_owned();
        Series::start(path, frames_per_second, head, &MESH).map(Self)
    }

    /// Appends the mesh of a frame; frames come in the order of their numbers.
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

    /// Puts the file together; returns its path and size in bytes, or `None` where no frame was pushed. A
    /// second call does nothing and returns `None`.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn finish(&self) -> Result<Option<(PathBuf, u64)>, IoError> {
        self.0.finish()
    }
}

impl PointSeries {
    /// Begins a file of particles that are drawn as balls of this diameter in m.
    ///
    /// # Errors
    /// [`IoError::Write`] if nothing can be written beside it.
    pub fn start(path: &Path, frames_per_second: f64, diameter: f32) -> Result<Self, IoError> {
        let head = format!(
            "def Points \"particles\"\n    {{\n        float[] widths = [{diameter}] (\n            interpolation = \
             \"constant\"\n        )\n"
        );
        Series::start(path, frames_per_second, head, &POINTS).map(Self)
    }

    /// Appends the particles of a frame; frames come in the order of their numbers.
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

    /// As [`MeshSeries::finish`].
    ///
    /// # Errors
    /// As [`MeshSeries::finish`].
    pub fn finish(&self) -> Result<Option<(PathBuf, u64)>, IoError> {
        self.0.finish()
    }
}

/// One prim with its samples so far.
#[derive(Debug)]
struct Series {
    path: PathBuf,
    frames_per_second: f64,
    /// The prim as far as it is the same in every frame.
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
        // Taken out, so that the hidden files go away whatever happens.
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

    /// A panic while the lock was held left a sample cut short; the frames would not fit each other.
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
