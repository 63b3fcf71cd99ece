//! Creating the subfolders of a run.

use splashdown::scene::{Format, Scene};
use splashdown_io::{IoError, prepare_folder};

use super::{BODIES, PROBES, RunFolder, numbered};

/// The subfolders that a run needs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Subfolders {
    /// Particles.
    pub particles: bool,
    /// Droplets.
    pub droplets: bool,
    /// Surface meshes.
    pub mesh: bool,
    /// Pictures.
    pub pictures: bool,
    /// Probe tables.
    pub probes: bool,
    /// Tables and meshes of bodies.
    pub bodies: bool,
    /// Checkpoints.
    pub checkpoints: bool,
}

impl Subfolders {
    /// The subfolders that the scene's output needs.
    pub fn of(scene: &Scene, pictures: bool, checkpoints: bool) -> Self {
        let any = |wanted: fn(Format) -> bool| {
            scene.output.formats.iter().any(|&format| format.is_numbered() && wanted(format))
        };
        Self {
            particles: any(Format::has_particles) || (scene.foam.enabled && any(Format::has_points)),
            droplets: scene.surface.separates() && any(Format::has_points),
            mesh: scene.surface.enabled && any(Format::has_surface),
            pictures,
            probes: !scene.probes.is_empty(),
            bodies: !scene.bodies.is_empty(),
            checkpoints,
        }
    }
}

impl RunFolder {
    /// Creates the folder and checks that files can be written into it.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub(crate) fn create(&self) -> Result<(), IoError> {
        prepare_folder(&self.root)
    }

    /// Creates these subfolders, and checks that files can be written into them.
    ///
    /// # Errors
    /// [`IoError::Write`].
    pub(crate) fn create_subfolders(&self, wanted: Subfolders) -> Result<(), IoError> {
        self.create()?;
        let subfolders = [
            (wanted.particles, numbered::PARTICLES.folder),
            (wanted.droplets, numbered::DROPLETS),
            (wanted.mesh, numbered::MESHES.folder),
            (wanted.pictures, numbered::PICTURES.folder),
            (wanted.probes, PROBES),
            (wanted.bodies, BODIES),
            (wanted.checkpoints, numbered::CHECKPOINTS),
        ];
        for (_, name) in subfolders.into_iter().filter(|(wanted, _)| *wanted) {
            prepare_folder(&self.root.join(name))?;
        }
        Ok(())
    }
}
