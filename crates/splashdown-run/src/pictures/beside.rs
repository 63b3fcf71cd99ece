//! What is drawn beside the fluid of a frame: bodies and foam, from memory or from the files of a finished run.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use splashdown::BodyState;
use splashdown::foam::{DiffuseKind, DiffuseParticles};
use splashdown::scene::{Body, Motion, Scene};
use splashdown_io::{Format, IoError, read_particles_with_attributes};

use crate::playback::scripted;
use crate::{RunError, body_table};

/// Bodies and foam of a frame.
#[derive(Clone, Debug, Default)]
pub struct Beside {
    /// The states of the scene's bodies, in its order. Bodies without a state are not drawn.
    pub bodies: Arc<[BodyState]>,
    /// Foam, spray and bubbles.
    pub foam: Option<Arc<DiffuseParticles>>,
}

impl Beside {
    /// Reads what belongs to the frame of a file in the folder of a finished run, such as `out/mesh/surface_0012.ply`.
    ///
    /// # Errors
    /// [`RunError::Input`] that says which file is missing and how to draw without it; [`RunError::Io`].
    pub fn of_file(path: &Path, scene: &Scene) -> Result<Self, RunError> {
        FrameOfFile::of(path, scene).beside(scene)
    }
}

/// The frame to which a file of a finished run belongs.
#[derive(Debug)]
pub(super) struct FrameOfFile {
    /// The output folder.
    root: PathBuf,
    /// The number as it is written in the name of the file, such as `0012`; `None` without one.
    digits: Option<String>,
    ending: String,
    /// Simulated time in s; 0 without a number.
    pub time: f64,
}

impl FrameOfFile {
    /// The frame of a file such as `out/mesh/surface_0012.ply`.
    pub fn of(path: &Path, scene: &Scene) -> Self {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let digits = &stem[stem.trim_end_matches(|c: char| c.is_ascii_digit()).len()..];
        let frame = digits.parse().unwrap_or(0.0);
        Self {
            root: path.parent().and_then(Path::parent).unwrap_or(Path::new("")).to_owned(),
            digits: (!digits.is_empty()).then(|| digits.to_owned()),
            ending: path.extension().unwrap_or_default().to_string_lossy().into_owned(),
            time: frame / f64::from(scene.frame_rate),
        }
    }

    /// Reads the bodies and the foam of the frame.
    ///
    /// # Errors
    /// [`RunError::Input`] that says which file is missing and how to draw without it; [`RunError::Io`].
    pub fn beside(&self, scene: &Scene) -> Result<Beside, RunError> {
        let bodies = scene.bodies.iter().map(|body| self.body(body, scene)).collect::<Result<Vec<_>, _>>()?;
        let foam = if scene.foam.enabled { Some(Arc::new(self.foam()?)) } else { None };
        Ok(Beside { bodies: bodies.into(), foam })
    }

    fn body(&self, body: &Body, scene: &Scene) -> Result<BodyState, RunError> {
        let path = self.root.join("bodies").join(format!("{}.csv", body.name));
        let tolerance = 0.5 / f64::from(scene.frame_rate);
        if path.exists() {
            if let Some(state) = body_table::read(&path, self.time, tolerance)? {
                return Ok(state);
            }
            let (path, time) = (path.display(), self.time);
            return Err(RunError::Input(format!(
                "`{path}` has no row at {time:.4} s; give the scene of the run, whose frame rate determines the time of a frame"
            )));
        }
        // The motion of other bodies does not depend on the run.
        match &body.motion {
            Motion::Static => Ok(BodyState::at(body.mesh.position, body.mesh.rotation)),
            Motion::Scripted(script) => Ok(scripted(script, self.time)),
            Motion::Dynamic { .. } => Err(RunError::Input(format!(
                "`{}` is missing, so the place of body {:?} is unknown; keep the files of a run in its folder, or remove the body \
                 from the scene",
                path.display(),
                body.name
            ))),
        }
    }

    fn foam(&self) -> Result<DiffuseParticles, RunError> {
        let digits = self.digits.as_deref().unwrap_or_default();
        let mut parts = Vec::new();
        for (kind, name) in DiffuseKind::ALL {
            let file = |ending: &str| {
                let ending = ending.trim_start_matches('.');
                self.root.join("particles").join(format!("{name}_{digits}.{ending}"))
            };
            let endings = Format::endings(Format::reads_particles);
            // GLB files of foam are written and not read.
            let own = Format::with_ending(&self.ending).filter(|format| format.reads_particles());
            let endings = own.map(|format| format.ending).into_iter().chain(endings);
            match endings.map(file).find(|path| path.exists()) {
                Some(path) => match read_particles_with_attributes(&path) {
                    Ok(particles) => parts.push((kind, particles)),
                    // Before the first splash.
                    Err(IoError::NoParticles { .. }) => {}
                    Err(error) => return Err(error.into()),
                },
                None => {
                    return Err(RunError::Input(format!(
                        "`{}` is missing, in any format; the run must write particles as well, or disable the foam in the scene \
                         (foam.enabled = false)",
                        file("*").display()
                    )));
                }
            }
        }
        Ok(DiffuseParticles::of_kinds(&parts))
    }
}
