//! Pictures of frames that are already computed.

use std::sync::Arc;

use splashdown::scene::{PictureKind, Scene};
use splashdown_io::{Mesh, Particles, Picture};

use super::draw::FrameRenderer;
use super::{FrameData, drawing_device};
use crate::RunError;

/// Draws pictures of frames that are already computed, such as those in the files of a finished run: those that the run
/// draws, without bodies and foam.
///
/// ```no_run
/// use splashdown::scene::{PictureKind, Scene};
/// use splashdown_io::{picture::write_png, read_particles};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let scene = Scene::load("my.toml")?;
/// let mut painter = splashdown_run::Painter::new(&scene, PictureKind::Particles)?;
/// let particles = read_particles("out/my/particles/particles_0010.ply".as_ref())?;
/// write_png("again.png".as_ref(), &*painter.particles(particles.into(), 0.2)?)?;
/// # Ok(())
/// # }
/// ```
pub struct Painter {
    renderer: FrameRenderer,
    kind: PictureKind,
}

impl Painter {
    /// Opens the best device, software drivers included.
    ///
    /// # Errors
    /// [`RunError::Gpu`] without a driver; [`RunError::Render`] if the device cannot draw pictures of the scene's size.
    pub fn new(scene: &Scene, kind: PictureKind) -> Result<Self, RunError> {
        let renderer = FrameRenderer::new(drawing_device(None)?, scene, &[], vec![kind])?;
        Ok(Self { renderer, kind })
    }

    /// Draws particles at a time in s.
    ///
    /// # Errors
    /// [`RunError::Input`] if the painter draws surfaces; [`RunError::Render`]; [`RunError::Gpu`] if the device was lost.
    pub fn particles(&mut self, particles: Arc<Particles>, time: f64) -> Result<Arc<Picture>, RunError> {
        self.expect(PictureKind::Particles)?;
        self.draw(particles, None, time)
    }

    /// Draws a surface at a time in s. Without normals, as in meshes that were read from files, those of the triangles are
    /// averaged.
    ///
    /// # Errors
    /// [`RunError::Input`] if the painter draws particles; [`RunError::Render`]; [`RunError::Gpu`] if the device was lost.
    pub fn surface(&mut self, mesh: Arc<Mesh>, time: f64) -> Result<Arc<Picture>, RunError> {
        self.expect(PictureKind::Surface)?;
        self.draw(Arc::default(), Some(mesh), time)
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
        mesh: Option<Arc<Mesh>>,
        time: f64,
    ) -> Result<Arc<Picture>, RunError> {
        let data = FrameData { index: 0, time, particles, mesh, foam: None, bodies: [].into() };
        let pictures = self.renderer.draw(&data)?;
        pictures.into_iter().next().ok_or_else(|| RunError::Input("no picture was drawn".to_owned()))
    }
}
