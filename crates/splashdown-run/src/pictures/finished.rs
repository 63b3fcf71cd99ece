//! The frames of a finished run, read from its folder to be drawn again.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use splashdown::SimulationError;
use splashdown::bodies::body_meshes;
use splashdown::scene::{PictureKind, Scene};
use splashdown_io::{Format, Picture, read_mesh};

use super::beside::{Beside, FrameOfFile};
use super::draw::FrameRenderer;
use super::droplets::separate;
use super::motion::{is_blurred, with_velocities};
use super::{FrameData, drawing_device};
use crate::RunError;
use crate::folder::MESHES;

/// Where the camera stands, relative to that of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    /// Added to the azimuth of the first frame, in degrees.
    pub azimuth: f32,
    /// Added to the azimuth from the first to the last frame, in degrees.
    pub turn: f32,
    /// Elevation above the horizon in degrees; `None`: that of the scene.
    pub elevation: Option<f32>,
    /// Factor on the distance.
    pub distance: f32,
}

impl Default for Orbit {
    fn default() -> Self {
        Self { azimuth: 0.0, turn: 0.0, elevation: None, distance: 1.0 }
    }
}

/// Draws surfaces from the files of a finished or interrupted run.
pub struct FinishedRun {
    folder: PathBuf,
    scene: Scene,
    meshes: Vec<(u32, PathBuf)>,
    renderer: FrameRenderer,
}

impl std::fmt::Debug for FinishedRun {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("FinishedRun")
            .field("folder", &self.folder)
            .field("meshes", &self.meshes.len())
            .finish()
    }
}

impl FinishedRun {
    /// Opens a folder with meshes of a scene.
    ///
    /// # Errors
    /// [`RunError::Input`] if there are no meshes; [`RunError::Simulation`] if the meshes of the bodies cannot be read;
    /// [`RunError::Gpu`] without a driver; [`RunError::Render`] if the device cannot draw pictures of the scene's size.
    pub fn open(folder: &Path, scene: &Scene) -> Result<Self, RunError> {
        let meshes = mesh_files(folder)?;
        let bodies = body_meshes(scene).map_err(SimulationError::from)?;
        let kinds = vec![PictureKind::Surface];
        let renderer = FrameRenderer::new(drawing_device(None)?, scene, &bodies, kinds)?;
        Ok(Self { folder: folder.to_owned(), scene: scene.clone(), meshes, renderer })
    }

    /// The numbers of the frames that have a mesh.
    pub fn frames(&self) -> impl Iterator<Item = u32> + Clone {
        self.meshes.iter().map(|(frame, _)| *frame)
    }

    /// Draws a frame; `progress` is 0 for the first and 1 for the last frame of the film.
    ///
    /// # Errors
    /// [`RunError::Input`] if there is no such frame or a file that the scene needs is missing; [`RunError::Io`] if its
    /// files cannot be read; [`RunError::Render`]; [`RunError::Gpu`] if the device was lost.
    pub fn draw(&mut self, frame: u32, orbit: &Orbit, progress: f32) -> Result<Arc<Picture>, RunError> {
        let Some((_, path)) = self.meshes.iter().find(|(number, _)| *number == frame) else {
            return Err(RunError::Input(format!("frame {frame} has no mesh in `{}`", self.folder.display())));
        };
        let (mut mesh, droplets) = separate(read_mesh(path)?, path, &self.scene)?;
        if is_blurred(&self.scene) {
            mesh = with_velocities(mesh, path, &self.scene)?;
        }
        let of_file = FrameOfFile::of(path, &self.scene);
        let time = of_file.time;
        let Beside { bodies, foam } = of_file.beside(&self.scene)?;
        let mut camera = self.scene.camera;
        camera.azimuth += orbit.azimuth + orbit.turn * progress;
        camera.elevation = orbit.elevation.unwrap_or(camera.elevation);
        camera.distance *= orbit.distance;
        self.renderer.set_camera(camera);
        let data = FrameData {
            index: frame,
            time,
            particles: Arc::default(),
            mesh: Some(Arc::new(mesh)),
            droplets: droplets.map(Arc::new),
            foam,
            bodies,
        };
        let pictures = self.renderer.draw(&data)?;
        pictures.into_iter().next().ok_or_else(|| RunError::Input("no picture was drawn".to_owned()))
    }
}

/// The mesh of every frame; of several formats the first that can be read.
fn mesh_files(folder: &Path) -> Result<Vec<(u32, PathBuf)>, RunError> {
    let readable = |path: &Path| Format::of(path).is_some_and(|format| format.reads_meshes());
    let mut files: Vec<(u32, PathBuf)> = MESHES.files(folder).filter(|(_, path)| readable(path)).collect();
    files.sort();
    let mut seen = BTreeSet::new();
    files.retain(|(frame, _)| seen.insert(*frame));
    if files.is_empty() {
        return Err(RunError::Input(format!(
            "`{}` contains no meshes that can be read (mesh/surface_0000.ply, ...): give the output folder of a run \
             with meshes as PLY, OBJ, STL or GLB",
            folder.display()
        )));
    }
    Ok(files)
}
