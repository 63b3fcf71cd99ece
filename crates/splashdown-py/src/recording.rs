//! Runs with files.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use splashdown::run::{Progress, Started};
use splashdown::scene::{Choice, Format, PictureKind};
use splashdown_run::{Reporter, RunEnd, RunRequest, RunSettings, Session, Stop};

use crate::checkpoint::Checkpoint;
use crate::errors::{ParameterError, Result};
use crate::progress;
use crate::scene::Scene;
use crate::simulation::warn;
use crate::surface::parse_device;

/// Runs a scene and writes its frames into the folder `out` ("out/" and the name of the scene by default), as the command
/// `splashdown run`. Given a folder of a run, or a checkpoint file, it resumes that run.
///
/// `formats` are those of `splashdown run --formats`, for example ["ply", "usd"]; `pictures` are "particles" and "surface".
/// `None` selects the values of the scene. Returns a dictionary with `folder`, `frames` (complete ones, with the initial
/// one), `files`, and, unless the run was stopped, `steps`, `wall` (s) and `density_error`. Ctrl-C completes the current
/// frame, writes a checkpoint and raises `KeyboardInterrupt`.
///
/// >>> result = splashdown.run(scene, folder / "out", frames=1, formats=["ply"], pictures=[], device="cpu")
/// >>> result["frames"], (folder / "out/mesh/surface_0001.ply").exists()
/// (2, True)
#[pyfunction]
#[pyo3(signature = (scene, out = None, *, device = None, frames = None, formats = None, pictures = None, surface = true, film = true, checkpoint_every = None, progress = None))]
#[expect(clippy::too_many_arguments, reason = "they are keyword arguments in Python")]
pub fn run<'py>(
    py: Python<'py>,
    scene: &Bound<'py, PyAny>,
    out: Option<PathBuf>,
    device: Option<&str>,
    frames: Option<u32>,
    formats: Option<Vec<String>>,
    pictures: Option<Vec<String>>,
    surface: bool,
    film: bool,
    checkpoint_every: Option<u32>,
    progress: Option<&Bound<'py, PyAny>>,
) -> Result<Bound<'py, PyDict>> {
    let mut settings = RunSettings::default();
    settings.device = device.map(parse_device).transpose()?;
    settings.frames = frames;
    settings.formats = formats.map(|words| words_of::<Format>("formats", &words)).transpose()?;
    settings.pictures = pictures.map(|words| words_of::<PictureKind>("pictures", &words)).transpose()?;
    settings.surface = surface;
    settings.film = film;
    settings.checkpoint_every = checkpoint_every;
    let mut request = match scene.cast::<Scene>() {
        Ok(scene) => RunRequest::new(scene.get().0.clone(), settings),
        Err(_) if scene.cast::<Checkpoint>().is_ok() => {
            let message = "to continue a run with files, give the path of its folder or of a checkpoint file";
            return Err(ParameterError::new_err(message).into());
        }
        Err(_) => RunRequest::resume(&scene.extract::<PathBuf>()?, settings)?,
    };
    request.out = out;
    let mut reporter = PythonReporter {
        reporter: progress::Reporter::new(progress)?,
        interrupt: None,
        warnings: Vec::new(),
    };
    let outcome = py.detach(|| {
        let session = Session::start(request, &mut reporter)?;
        // The reporter is borrowed during the run, so it passes interrupts through a flag of its own.
        let interrupted = std::cell::Cell::new(false);
        let mut watching = Watching { inner: &mut reporter, interrupted: &interrupted };
        let stop = || if interrupted.get() { Stop::AfterFrame } else { Stop::No };
        Ok::<_, splashdown_run::RunError>(session.finish(&mut watching, &stop))
    })?;
    reporter.reporter.close(py)?;
    warn(py, &reporter.warnings)?;
    if let Some(interrupt) = reporter.interrupt {
        return Err(interrupt.into());
    }
    let result = PyDict::new(py);
    match outcome.end {
        RunEnd::Failed(error) => return Err(error.into()),
        RunEnd::Finished(summary) => {
            result.set_item("steps", summary.steps)?;
            result.set_item("wall", summary.wall)?;
            result.set_item("density_error", summary.density_error)?;
        }
        _ => {}
    }
    result.set_item("folder", outcome.folder.root())?;
    result.set_item("frames", outcome.complete_frames)?;
    let files: Vec<_> = outcome.files.iter().chain(&outcome.films).map(|file| file.path.clone()).collect();
    result.set_item("files", files)?;
    Ok(result)
}

/// Words of a scene file.
fn words_of<C: Choice>(name: &str, words: &[String]) -> Result<Vec<C>> {
    words.iter().map(|word| word_of(name, word)).collect()
}

/// A word of a scene file.
///
/// # Errors
/// `ParameterError` that lists the allowed words.
pub fn word_of<C: Choice>(name: &str, word: &str) -> Result<C> {
    C::from_name(word).ok_or_else(|| {
        let known: Vec<_> = C::ALL.iter().map(|&(_, known, _)| known).collect();
        ParameterError::new_err(format!("{name} has {word:?}; allowed are {}", known.join(", "))).into()
    })
}

/// Passes progress to Python, and remembers Ctrl-C.
struct PythonReporter {
    reporter: progress::Reporter,
    interrupt: Option<PyErr>,
    warnings: Vec<String>,
}

/// A reporter that sets a flag when the run has to stop.
struct Watching<'a> {
    inner: &'a mut PythonReporter,
    interrupted: &'a std::cell::Cell<bool>,
}

impl Reporter for PythonReporter {
    fn warning(&mut self, text: &str) {
        self.warnings.push(text.to_owned());
    }

    fn progress(&mut self, progress: &Progress) {
        if self.interrupt.is_none() {
            self.interrupt = Python::attach(|py| self.reporter.report(py, progress.into())).err();
        }
    }
}

impl Reporter for Watching<'_> {
    fn warning(&mut self, text: &str) {
        self.inner.warning(text);
    }

    fn started(&mut self, started: &Started) {
        self.inner.started(started);
    }

    fn progress(&mut self, progress: &Progress) {
        self.inner.progress(progress);
        self.interrupted.set(self.inner.interrupt.is_some());
    }
}
