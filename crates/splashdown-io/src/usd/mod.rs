//! USD, the scene format of film and animation, as text (`.usda`): all frames of a run in one file, as time samples.
//!
//! Blender, Houdini, Maya, `usdview` and Omniverse open it. [`MeshSeries`] is the animated surface, [`PointSeries`] the
//! particles. Velocities are the attribute `velocities`, which these programs use for motion blur.
//!
//! *How it works.* The file contains all frames of one attribute before the next attribute, so a frame cannot be
//! appended to it. Each attribute has a file of its own (`spool`), to which frames are appended; `finish` joins these
//! files. Those of a kept series remain when the process is killed, so that a resumed run
//! continues them. A finished file is continued too: it is split into its attributes again.
//!
//! *Why own code:* the text has five kinds of lines. The crate `openusd` 0.8 is new and needs a newer compiler; the C++
//! library takes an hour to build. `tests/foreign` opens the files with Pixar's library. *Why text:* the binary form
//! (`usdc`), with about a third of the size, is documented only by the source of that library.

mod resume;
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

/// The ending of the files of a kept series, without its dot.
pub const PART_ENDING: &str = "usdpart";

/// Where a series is written.
#[derive(Debug)]
struct Place {
    path: PathBuf,
    frames_per_second: f64,
    /// The folder for the data until the file is complete. `None`: the data disappears with the process.
    keep: Option<PathBuf>,
}

impl Place {
    fn new(path: &Path, frames_per_second: f64, keep: Option<&Path>) -> Self {
        Self { path: path.to_owned(), frames_per_second, keep: keep.map(Path::to_owned) }
    }

    /// The files of a kept series.
    fn parts(&self, attributes: &[Attribute]) -> Option<Vec<PathBuf>> {
        let name = self.path.file_stem().unwrap_or_default().to_string_lossy();
        let folder = self.keep.as_ref()?;
        Some(attributes.iter().map(|attribute| Spool::path(folder, &name, attribute)).collect())
    }
}

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
    /// Begins a series. [`MeshSeries::finish`] creates the file. Until then its data is in temporary files, or, if a
    /// folder to `keep` it is given, in files `STEM_ATTRIBUTE.usdpart` from which [`MeshSeries::resume`] continues.
    ///
    /// # Errors
    /// [`IoError::Write`] if its folder is not writable.
    pub fn start_in(path: &Path, frames_per_second: f64, keep: Option<&Path>) -> Result<Self, IoError> {
        Series::start(Place::new(path, frames_per_second, keep), Self::head(), &MESH).map(Self)
    }

    /// Begins a series whose data is not kept.
    ///
    /// # Errors
    /// [`IoError::Write`] if its folder is not writable.
    pub fn start(path: &Path, frames_per_second: f64) -> Result<Self, IoError> {
        Self::start_in(path, frames_per_second, None)
    }

    /// Continues the series of an earlier process after the frame `last`, from its kept data or from its complete file.
    /// Later frames are removed. `None` if there is no such series that ends with this frame.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn resume(
        path: &Path,
        frames_per_second: f64,
        keep: Option<&Path>,
        last: u32,
    ) -> Result<Option<Self>, IoError> {
        let place = Place::new(path, frames_per_second, keep);
        Ok(Series::resume(place, Self::head(), &MESH, last)?.map(Self))
    }

    fn head() -> String {
        "def Mesh \"surface\"\n    {\n        uniform token subdivisionScheme = \"none\"\n        \
         uniform token orientation = \"rightHanded\"\n"
            .to_owned()
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

    /// Flushes the data of a kept series to the disk.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn sync(&self) -> Result<(), IoError> {
        self.0.sync()
    }
}

impl PointSeries {
    /// Begins a series of particles, which are shown as spheres of this diameter in m. Otherwise like
    /// [`MeshSeries::start_in`].
    ///
    /// # Errors
    /// Those of [`MeshSeries::start_in`].
    pub fn start_in(
        path: &Path,
        frames_per_second: f64,
        diameter: f32,
        keep: Option<&Path>,
    ) -> Result<Self, IoError> {
        Series::start(Place::new(path, frames_per_second, keep), Self::head(path, diameter), &POINTS)
            .map(Self)
    }

    /// Begins a series whose data is not kept.
    ///
    /// # Errors
    /// [`IoError::Write`] if its folder is not writable.
    pub fn start(path: &Path, frames_per_second: f64, diameter: f32) -> Result<Self, IoError> {
        Self::start_in(path, frames_per_second, diameter, None)
    }

    /// Like [`MeshSeries::resume`].
    ///
    /// # Errors
    /// Those of [`MeshSeries::resume`].
    pub fn resume(
        path: &Path,
        frames_per_second: f64,
        diameter: f32,
        keep: Option<&Path>,
        last: u32,
    ) -> Result<Option<Self>, IoError> {
        let place = Place::new(path, frames_per_second, keep);
        Ok(Series::resume(place, Self::head(path, diameter), &POINTS, last)?.map(Self))
    }

    /// The points have the name of the file without the number of its first frame: several files can be loaded together.
    fn head(path: &Path, diameter: f32) -> String {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let word = stem.split('_').next().unwrap_or_default();
        let is_name = !word.is_empty() && word.bytes().all(|letter| letter.is_ascii_alphabetic());
        let name = if is_name { word } else { "particles" };
        format!(
            "def Points \"{name}\"\n    {{\n        float[] widths = [{diameter}] (\n            interpolation = \
             \"constant\"\n        )\n"
        )
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

    /// Flushes the data of a kept series to the disk.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub fn sync(&self) -> Result<(), IoError> {
        self.0.sync()
    }
}

/// A prim with its samples so far.
#[derive(Debug)]
struct Series {
    place: Place,
    /// The beginning of the prim, with attributes that are constant in time.
    head: String,
    attributes: &'static [Attribute],
    state: Mutex<State>,
}

#[derive(Debug)]
struct State {
    /// One per attribute, or none before the first frame.
    spools: Vec<Spool>,
    /// Numbers of the first and the last frame.
    frames: Option<[u32; 2]>,
}

impl Series {
    fn start(place: Place, head: String, attributes: &'static [Attribute]) -> Result<Self, IoError> {
        let state = Mutex::new(State { spools: Vec::new(), frames: None });
        let series = Self { place, head, attributes, state };
        if series.place.keep.is_none() {
            series.state().spools = series.create().map_err(|error| series.failed(&error))?;
        }
        Ok(series)
    }

    /// The files for the first frame. Kept files are not created earlier, because a run that cannot start must not
    /// replace the data of an earlier one.
    fn create(&self) -> io::Result<Vec<Spool>> {
        let attributes = self.attributes.iter();
        match self.place.parts(self.attributes) {
            Some(parts) => {
                attributes.zip(&parts).map(|(attribute, path)| Spool::kept(path, attribute)).collect()
            }
            None => attributes.map(|attribute| Spool::temporary(&self.place.path, attribute)).collect(),
        }
    }

    fn push(&self, frame: u32, append: impl FnOnce(&mut [Spool]) -> io::Result<()>) -> Result<(), IoError> {
        let mut state = self.state();
        let attempt = || {
            if state.spools.is_empty() {
                state.spools = self.create()?;
            }
            append(&mut state.spools)?;
            state.spools.iter_mut().try_for_each(Spool::flush)
        };
        attempt().map_err(|error| self.failed(&error))?;
        let first = state.frames.map_or(frame, |[first, _]| first);
        state.frames = Some([first, frame]);
        Ok(())
    }

    fn sync(&self) -> Result<(), IoError> {
        if self.place.keep.is_none() {
            return Ok(());
        }
        self.state().spools.iter_mut().try_for_each(Spool::sync).map_err(|error| self.failed(&error))
    }

    fn finish(&self) -> Result<Option<(PathBuf, u64)>, IoError> {
        // The state is taken, so that temporary files are removed even on failure. Kept files remain on failure.
        let State { mut spools, frames } =
            std::mem::replace(&mut *self.state(), State { spools: Vec::new(), frames: None });
        let Some([first, last]) = frames else { return Ok(None) };
        let path = &self.place.path;
        let bytes = atomic::write(path, |out| {
            write!(
                out,
                "{HEADER} = {last}\n    framesPerSecond = {fps}\n    metersPerUnit = 1\n    startTimeCode = {first}\n    \
                 timeCodesPerSecond = {fps}\n    upAxis = \"Y\"\n)\n\ndef Xform \"splashdown\"\n{{\n    {}",
                self.head,
                fps = self.place.frames_per_second,
            )?;
            write!(
                out,
                "        color3f[] primvars:displayColor = [(0.2, 0.45, 0.6)] (\n            interpolation = \"constant\"\n        \
                 )\n"
            )?;
            for spool in &mut spools {
                spool.write_to(out)?;
            }
            writeln!(out, "    }}\n}}")
        })?;
        spool::remove(&self.place.parts(self.attributes).unwrap_or_default());
        Ok(Some((path.clone(), bytes)))
    }

    fn failed(&self, error: &io::Error) -> IoError {
        IoError::write(&self.place.path, error)
    }

    /// Ignores the panic of another thread that held the lock.
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The beginning of a file, up to the number of its last frame.
const HEADER: &str = "#usda 1.0\n(\n    defaultPrim = \"splashdown\"\n    doc = \"written by Splashdown; SI units\"\n    \
                      endTimeCode";
