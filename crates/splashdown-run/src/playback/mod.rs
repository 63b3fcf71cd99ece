//! The frames of a finished or interrupted run, read from its folder one at a time.
//!
//! A frame is what exists of it: a run may have written particles, meshes or both, in several formats, and a file may
//! be missing or truncated. Only a frame without particles and without a mesh is an error.

mod bodies;
mod files;
mod scene;

use std::path::{Path, PathBuf};

use splashdown::foam::{DiffuseKind, DiffuseParticles};
use splashdown::scene::{PictureKind, Scene};
use splashdown::{BodyMesh, BodyState, SimulationError};
use splashdown_io::{IoError, Mesh, Particles, read_mesh, read_particles, read_particles_with_attributes};

use crate::{RunError, RunFolder, appearance};
use bodies::Track;
use files::{FileIndex, FilesOfFrame};

pub(crate) use bodies::scripted;
pub use scene::{reported_scene, scene_of_run};

/// The frames in the folder of a run.
#[derive(Debug)]
pub struct RunFrames {
    folder: PathBuf,
    scene: Scene,
    index: FileIndex,
    tracks: Vec<Track>,
    problems: Vec<String>,
}

/// One frame.
#[derive(Debug, Default)]
pub struct PlayedFrame {
    /// Its number.
    pub number: u32,
    /// Simulated time in s.
    pub time: f64,
    /// The particles, if a file of them can be read.
    pub particles: Option<Particles>,
    /// The surface, if a file of it can be read.
    pub mesh: Option<Mesh>,
    /// The droplets beside the surface.
    pub droplets: Option<Particles>,
    /// Foam, spray and bubbles.
    pub foam: Option<DiffuseParticles>,
    /// The states of the bodies, in the order of [`RunFrames::body_meshes`].
    pub bodies: Vec<BodyState>,
    /// Files that cannot be read, and why.
    pub problems: Vec<String>,
}

impl PlayedFrame {
    /// Bytes in its arrays.
    pub fn bytes(&self) -> usize {
        let particles = |particles: &Particles| {
            let attributes: usize = particles.attributes.iter().map(|values| values.values.len()).sum();
            4 * (particles.ids.len() + particles.densities.len() + particles.pressures.len() + attributes)
                + 12 * (particles.positions.len() + particles.velocities.len())
        };
        let mesh = self.mesh.as_ref().map_or(0, |mesh| {
            let attributes: usize = mesh.attributes.iter().map(|values| values.values.len()).sum();
            let vectors = mesh.vertices.len() + mesh.normals.len() + mesh.velocities.len();
            12 * (vectors + mesh.triangles.len()) + 4 * attributes
        });
        let points = [&self.particles, &self.droplets].into_iter().flatten().map(particles).sum::<usize>();
        mesh + points + self.foam.as_ref().map_or(0, |foam| 40 * foam.positions.len())
    }
}

impl RunFrames {
    /// Lists the frames in a folder. `scene` is that of the run; `None`: the one that the folder names.
    ///
    /// # Errors
    /// [`RunError::UnknownScene`]; [`RunError::Input`] if the folder has no frames.
    pub fn open(folder: &Path, scene: Option<Scene>) -> Result<Self, RunError> {
        let index = FileIndex::of(folder);
        if index.is_empty() {
            return Err(RunError::Input(format!(
                "`{}` contains no frames to play (particles/particles_0000.ply, mesh/surface_0000.ply, ...)",
                folder.display()
            )));
        }
        let scene = scene.map_or_else(|| scene_of_run(folder), Ok)?;
        let (tracks, problems) = bodies::tracks(&RunFolder::new(folder.to_owned(), 0), &scene);
        Ok(Self { folder: folder.to_owned(), scene, index, tracks, problems })
    }

    /// Whether a folder contains frames.
    pub fn exist_in(folder: &Path) -> bool {
        !FileIndex::of(folder).is_empty()
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The scene of the run.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The numbers of the frames, ascending; there is at least one.
    pub fn numbers(&self) -> impl Iterator<Item = u32> + Clone {
        self.index.numbers()
    }

    /// Whether a frame has particles, and whether one has a mesh.
    pub fn has_particles_and_meshes(&self) -> (bool, bool) {
        self.index.has_particles_and_meshes()
    }

    /// Whether the folder has a checkpoint to continue from.
    pub fn has_checkpoint(&self) -> bool {
        !RunFolder::new(self.folder.clone(), 0).checkpoints().is_empty()
    }

    /// What is missing: numbers without a file, frames with only a part of the files, and bodies without a table or with
    /// an incomplete one.
    pub fn problems(&self) -> impl Iterator<Item = String> {
        self.index.problems().into_iter().chain(self.problems_beside(|_| true))
    }

    /// What is missing beside the fluid in these frames: foam, and the places of bodies.
    pub(crate) fn problems_beside(&self, wanted: impl Fn(u32) -> bool) -> Vec<String> {
        let foam = self.scene.foam.enabled.then(|| self.index.without_foam(&wanted)).flatten();
        let meshes = appearance::mesh_problem(&self.scene).filter(|_| self.has_particles_and_meshes().1);
        let mut problems: Vec<String> =
            foam.into_iter().chain(meshes).chain(self.problems.iter().cloned()).collect();
        let tolerance = 0.5 / f64::from(self.scene.frame_rate);
        for track in &self.tracks {
            let is_unknown = |&number: &u32| wanted(number) && !track.knows(self.time(number), tolerance);
            let unknown = files::ranges(self.numbers().filter(is_unknown));
            if !unknown.is_empty() {
                problems.push(format!(
                    "the body {:?} is shown at its nearest known place in {}: its table has no row of them",
                    track.name,
                    files::listed(&unknown)
                ));
            }
        }
        problems
    }

    /// Simulated time of a frame in s.
    pub(crate) fn time(&self, number: u32) -> f64 {
        f64::from(number) / f64::from(self.scene.frame_rate)
    }

    /// The numbers of the frames with files from which pictures of this kind are drawn, ascending.
    pub(crate) fn numbers_with(&self, kind: PictureKind) -> impl Iterator<Item = u32> + Clone {
        self.numbers().filter(move |&number| {
            self.index.files(number).is_some_and(|files| match kind {
                PictureKind::Particles => !files.particles.is_empty(),
                PictureKind::Surface => !files.meshes.is_empty(),
            })
        })
    }

    /// The states of the bodies at a time in s, which may lie between two frames, in the order of
    /// [`RunFrames::body_meshes`].
    pub fn bodies_at(&self, time: f64) -> Vec<BodyState> {
        self.tracks.iter().map(|track| track.state_between(time)).collect()
    }

    /// The names of the bodies whose places are known.
    pub(crate) fn body_names(&self) -> impl Iterator<Item = &str> {
        self.tracks.iter().map(|track| track.name.as_str())
    }

    /// The meshes of the bodies whose places are known.
    ///
    /// # Errors
    /// [`RunError::Simulation`] if a mesh cannot be read.
    pub fn body_meshes(&self) -> Result<Vec<BodyMesh>, RunError> {
        let meshes = splashdown::bodies::body_meshes(&self.scene).map_err(SimulationError::from)?;
        let is_known = |mesh: &BodyMesh| self.tracks.iter().any(|track| track.name == mesh.name);
        Ok(meshes.into_iter().filter(is_known).collect())
    }

    /// Reads a frame.
    ///
    /// # Errors
    /// [`RunError::Input`] if there is no such frame, or neither its particles nor its mesh can be read.
    pub fn read(&self, number: u32) -> Result<PlayedFrame, RunError> {
        self.read_for(None, number)
    }

    /// Reads what is needed for pictures of this kind: those of particles need neither mesh nor droplets. `None`: everything.
    ///
    /// # Errors
    /// As [`RunFrames::read`].
    pub(crate) fn read_for(&self, kind: Option<PictureKind>, number: u32) -> Result<PlayedFrame, RunError> {
        let Some(files) = self.index.files(number) else {
            return Err(RunError::Input(format!("`{}` has no frame {number}", self.folder.display())));
        };
        let mut frame = PlayedFrame { number, time: self.time(number), ..PlayedFrame::default() };
        let FilesOfFrame { particles, meshes, droplets, diffuse } = files;
        let problems = &mut frame.problems;
        frame.particles = first(particles, read_points, problems);
        // The surface of no particles is a file without triangles, which is not a problem.
        let is_empty = frame.particles.as_ref().is_some_and(Particles::is_empty);
        let with_surface = kind != Some(PictureKind::Particles);
        if !is_empty && with_surface {
            frame.mesh = first(meshes, read_mesh, problems);
        }
        if with_surface {
            frame.droplets = first(droplets, read_points, problems);
        }
        if frame.particles.is_none() && frame.mesh.is_none() {
            return Err(RunError::Input(frame.problems.join("; ")));
        }
        let parts: Vec<(DiffuseKind, Particles)> = DiffuseKind::ALL
            .iter()
            .zip(diffuse)
            .filter_map(|((kind, _), paths)| Some((*kind, first(paths, read_diffuse, problems)?)))
            .collect();
        frame.foam = (!parts.is_empty()).then(|| DiffuseParticles::of_kinds(&parts));
        frame.bodies = self.tracks.iter().map(|track| track.state(frame.time)).collect();
        Ok(frame)
    }
}

/// The first file that can be read. Others are problems only if none can be.
fn first<T>(
    paths: &[PathBuf],
    read: impl Fn(&Path) -> Result<T, IoError>,
    problems: &mut Vec<String>,
) -> Option<T> {
    let mut failures = Vec::new();
    for path in paths {
        match read(path) {
            Ok(value) => return Some(value),
            Err(error) => failures.push(error.to_string()),
        }
    }
    problems.append(&mut failures);
    None
}

/// A file without particles is not a problem: emitters may not have started.
fn or_none(read: Result<Particles, IoError>) -> Result<Particles, IoError> {
    match read {
        Err(IoError::NoParticles { .. }) => Ok(Particles::default()),
        other => other,
    }
}

fn read_points(path: &Path) -> Result<Particles, IoError> {
    or_none(read_particles(path))
}

fn read_diffuse(path: &Path) -> Result<Particles, IoError> {
    or_none(read_particles_with_attributes(path))
}
