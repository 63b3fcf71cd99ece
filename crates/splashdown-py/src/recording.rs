//! Runs with files.

use std::path::{Path, PathBuf};

use pyo3::prelude::*;
use pyo3::types::PyDict;
use splashdown::run::{Progress, Started};
use splashdown::scene::{Format, OnBurst, PictureKind, presets};
use splashdown_run::{Reporter, RunEnd, RunRequest, RunSettings, Session, Stop};

use crate::argument::{Words, whole, word};
use crate::checkpoint::Checkpoint;
use crate::errors::{ParameterError, Result};
use crate::progress;
use crate::scene::Scene;
use crate::simulation::warn;
use crate::surface::parse_device;

/// Runs a scene and writes its frames into the folder `out` ("out/" and the name of the scene by default), as the command
/// `splashdown run`. Given a folder of a run, or a checkpoint file, it resumes that run.
///
/// `formats` are those of `splashdown run --formats`, for example ["ply", "usd"]; `pictures` are "particles" and "surface",
/// or an empty list. `on_burst` is "stop" (the default: `SimulationError`, and a checkpoint of the last sound frame), "warn"
/// or "ignore".
/// `None` selects the values of the scene. Returns a dictionary with `folder`, `frames` (complete ones, with the initial
/// one), `files`, and, unless the run was stopped, `steps`, `wall` (s), `density_error` and its two sides
/// `density_excess` and `density_deficit`. Ctrl-C completes the current frame, writes a checkpoint and raises
/// `KeyboardInterrupt`.
///
/// >>> result = splashdown.run(scene, folder / "out", frames=1, formats=["ply"], pictures=[], device="cpu")
/// >>> result["frames"], (folder / "out/mesh/surface_0001.ply").exists()
/// (2, True)
#[pyfunction]
#[pyo3(signature = (scene, out = None, *, device = None, frames = None, formats = None, pictures = None, surface = true, film = true, checkpoint_every = None, on_burst = None, progress = None))]
#[expect(clippy::too_many_arguments, reason = "they are keyword arguments in Python")]
pub fn run<'py>(
    py: Python<'py>,
    scene: &Bound<'py, PyAny>,
    out: Option<PathBuf>,
    device: Option<&str>,
    frames: Option<i64>,
    formats: Option<Words>,
    pictures: Option<Words>,
    surface: bool,
    film: bool,
    checkpoint_every: Option<i64>,
    on_burst: Option<&str>,
    progress: Option<&Bound<'py, PyAny>>,
) -> Result<Bound<'py, PyDict>> {
    let mut settings = RunSettings::default();
    settings.device = device.map(parse_device).transpose()?;
    settings.frames = whole("frames", frames, 1)?;
    settings.formats = formats.map(|words| words.choices::<Format>("formats")).transpose()?;
    settings.pictures = pictures.map(|words| words.choices::<PictureKind>("pictures")).transpose()?;
    settings.surface = surface;
    settings.film = film;
    settings.checkpoint_every = whole("checkpoint_every", checkpoint_every, 1)?;
    settings.on_burst = on_burst.map(|given| word::<OnBurst>("on_burst", given)).transpose()?;
    let mut request = match scene.cast::<Scene>() {
        Ok(scene) => RunRequest::new(scene.get().0.clone(), settings),
        Err(_) if scene.cast::<Checkpoint>().is_ok() => {
            let message = "to continue a run with files, give the path of its folder or of a checkpoint file";
            return Err(ParameterError::new_err(message).into());
        }
        Err(_) => resumed(&scene.extract::<PathBuf>()?, settings)?,
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
            result.set_item("density_error", summary.density_error())?;
            result.set_item("density_excess", summary.density_excess)?;
            result.set_item("density_deficit", summary.density_deficit)?;
        }
        _ => {}
    }
    result.set_item("folder", outcome.folder.root())?;
    result.set_item("frames", outcome.complete_frames)?;
    let files: Vec<_> = outcome.files.iter().chain(&outcome.films).map(|file| file.path.clone()).collect();
    result.set_item("files", files)?;
    Ok(result)
}

/// The run in a folder or a checkpoint file. A user who names a scene gets the call for that.
fn resumed(path: &Path, settings: RunSettings) -> Result<RunRequest> {
    let name = path.display();
    let call = if path.extension().is_some_and(|ending| ending == "toml") {
        format!("splashdown.Scene.load({:?})", name.to_string())
    } else if !path.exists() && presets().iter().any(|(known, _)| path.as_os_str() == *known) {
        format!("splashdown.Scene.preset({:?})", name.to_string())
    } else {
        return Ok(RunRequest::resume(path, settings)?);
    };
    let message = format!("`{name}` is a scene and not the folder of a run: give {call}");
    Err(ParameterError::new_err(message).into())
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
