//! Pictures of frames that are already computed.

use std::path::Path;
use std::sync::Arc;

use splashdown::SimulationError;
use splashdown::bodies::body_meshes;
use splashdown::scene::{PictureKind, Scene};
use splashdown_io::{Mesh, Particles, Picture, read_mesh, read_particles};

use super::beside::{Beside, FrameOfFile};
use super::draw::FrameRenderer;
use super::droplets::separate;
use super::motion::{is_blurred, with_velocities};
use super::{FrameData, drawing_device};
use crate::RunError;

/// Draws pictures of frames that are already computed, such as those in the files of a finished run, as the run draws
/// them.
///
/// ```no_run
/// use splashdown::scene::{PictureKind, Scene};
/// use splashdown_io::picture::write_png;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let scene = Scene::load("my.toml")?;
/// let mut painter = splashdown_run::Painter::new(&scene, PictureKind::Particles)?;
/// let picture = painter.file("out/my/particles/particles_0010.ply".as_ref(), None)?;
/// write_png("again.png".as_ref(), &*picture)?;
/// # Ok(())
/// # }
/// ```
pub struct Painter {
    renderer: FrameRenderer,
    kind: PictureKind,
    scene: Scene,
}

impl Painter {
    /// Opens the best device, software drivers included, and reads the meshes of the scene's bodies.
    ///
    /// # Errors
    /// [`RunError::Gpu`] without a driver; [`RunError::Render`] if the device cannot draw pictures of the scene's size;
    /// [`RunError::Simulation`] if a mesh cannot be read.
    pub fn new(scene: &Scene, kind: PictureKind) -> Result<Self, RunError> {
        let bodies = body_meshes(scene).map_err(SimulationError::from)?;
        let renderer = FrameRenderer::new(drawing_device(None)?, scene, &bodies, vec![kind])?;
        Ok(Self { renderer, kind, scene: scene.clone() })
    }

    /// Draws particles at a time in s.
    ///
    /// # Errors
    /// [`RunError::Input`] if the painter draws surfaces; [`RunError::Render`]; [`RunError::Gpu`] if the device was lost.
    pub fn particles(
        &mut self,
        particles: Arc<Particles>,
        beside: &Beside,
        time: f64,
    ) -> Result<Arc<Picture>, RunError> {
        self.expect(PictureKind::Particles)?;
        self.draw(particles, (None, None), beside, time)
    }

    /// Draws a surface at a time in s. Without normals, as in meshes that were read from files, those of the triangles are
    /// averaged.
    ///
    /// # Errors
    /// [`RunError::Input`] if the painter draws particles; [`RunError::Render`]; [`RunError::Gpu`] if the device was lost.
    pub fn surface(&mut self, mesh: Arc<Mesh>, beside: &Beside, time: f64) -> Result<Arc<Picture>, RunError> {
        self.surface_with_droplets(mesh, None, beside, time)
    }

    /// As [`surface`](Self::surface), with droplets: particles that are not part of the mesh, with positions and velocities.
    ///
    /// # Errors
    /// As [`surface`](Self::surface).
    pub fn surface_with_droplets(
        &mut self,
        mesh: Arc<Mesh>,
        droplets: Option<Arc<Particles>>,
        beside: &Beside,
        time: f64,
    ) -> Result<Arc<Picture>, RunError> {
        self.expect(PictureKind::Surface)?;
        self.draw(Arc::default(), (Some(mesh), droplets), beside, time)
    }

    /// Draws a file of a finished run, with the bodies, the foam and the droplets of its frame from the same output folder. The number at
    /// the end of the file's name is the frame, which gives the time unless `time` (s) does.
    ///
    /// # Errors
    /// [`RunError::Io`] if a file cannot be read; [`RunError::Input`] if a file that the scene needs is missing;
    /// [`RunError::Render`]; [`RunError::Gpu`] if the device was lost.
    pub fn file(&mut self, path: &Path, time: Option<f64>) -> Result<Arc<Picture>, RunError> {
        let frame = FrameOfFile::of(path, &self.scene);
        let time = time.unwrap_or(frame.time);
        match self.kind {
            PictureKind::Particles => {
                let particles = read_particles(path)?.into();
                let beside = frame.beside(&self.scene)?;
                self.particles(particles, &beside, time)
            }
            PictureKind::Surface => {
                let (mut mesh, droplets) = separate(read_mesh(path)?, path, &self.scene)?;
                if is_blurred(&self.scene) {
                    mesh = with_velocities(mesh, path, &self.scene)?;
                }
                let beside = frame.beside(&self.scene)?;
                self.surface_with_droplets(mesh.into(), droplets.map(Arc::new), &beside, time)
            }
        }
    }

    fn expect(&self, kind: PictureKind) -> Result<(), RunError> {
        if self.kind == kind {
            return Ok(());
        }
        let (given, expected) = match kind {
            PictureKind::Particles => ("particles", "surfaces"),
            PictureKind::Surface => ("a surface", "particles"),
        };
        Err(RunError::Input(format!(
            "this painter draws {expected}, and was given {given}: create another one"
        )))
    }

    fn draw(
        &mut self,
        particles: Arc<Particles>,
        (mesh, droplets): (Option<Arc<Mesh>>, Option<Arc<Particles>>),
        Beside { bodies, foam }: &Beside,
        time: f64,
    ) -> Result<Arc<Picture>, RunError> {
        let (foam, bodies) = (foam.clone(), Arc::clone(bodies));
        let data = FrameData { index: 0, time, particles, mesh, droplets, foam, bodies };
        let pictures = self.renderer.draw(&data)?;
        pictures.into_iter().next().ok_or_else(|| RunError::Input("no picture was drawn".to_owned()))
    }
}
