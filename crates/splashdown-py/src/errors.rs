//! Exceptions. Their classes are defined in `python/splashdown/_errors.py`, because they inherit from several classes.

use pyo3::PyErr;
use splashdown::SimulationError;
use splashdown::error::{CheckpointError, IoError, SceneErrors};
use splashdown::surface::SurfaceError;
use splashdown_run::RunError;

mod classes {
    use pyo3::import_exception;

    import_exception!(splashdown._errors, ArrayError);
    import_exception!(splashdown._errors, CheckpointError);
    import_exception!(splashdown._errors, ClosedError);
    import_exception!(splashdown._errors, DeviceError);
    import_exception!(splashdown._errors, FileError);
    import_exception!(splashdown._errors, ParameterError);
    import_exception!(splashdown._errors, SceneError);
    import_exception!(splashdown._errors, SimulationError);
}

pub use classes::{ArrayError, ClosedError, ParameterError, SceneError};

/// The result of a function of the package.
pub type Result<T, E = Failure> = std::result::Result<T, E>;

/// An error that becomes an exception. It has conversions from the errors of the libraries, which foreign types such as
/// [`PyErr`] cannot have.
#[derive(Debug)]
pub struct Failure(PyErr);

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        failure.0
    }
}

impl From<PyErr> for Failure {
    fn from(error: PyErr) -> Self {
        Self(error)
    }
}

/// The problems of a scene, as `SceneError(message, problems)`.
impl From<SceneErrors> for Failure {
    fn from(errors: SceneErrors) -> Self {
        let problems: Vec<String> = errors.errors.iter().map(|problem| problem.message.clone()).collect();
        Self(SceneError::new_err((errors.to_string(), problems)))
    }
}

impl From<CheckpointError> for Failure {
    fn from(error: CheckpointError) -> Self {
        match error {
            CheckpointError::Scene(errors) => errors.into(),
            error => Self(classes::CheckpointError::new_err(error.to_string())),
        }
    }
}

impl From<IoError> for Failure {
    fn from(error: IoError) -> Self {
        Self(classes::FileError::new_err(error.to_string()))
    }
}

impl From<SurfaceError> for Failure {
    fn from(error: SurfaceError) -> Self {
        let text = error.to_string();
        Self(match error {
            SurfaceError::Gpu(_) => classes::DeviceError::new_err(text),
            _ => ParameterError::new_err(text),
        })
    }
}

impl From<SimulationError> for Failure {
    fn from(error: SimulationError) -> Self {
        let text = error.to_string();
        Self(match error {
            SimulationError::Surface(error) => return error.into(),
            SimulationError::Checkpoint(error) => return (*error).into(),
            SimulationError::Gpu(_) | SimulationError::TooMany { .. } => classes::DeviceError::new_err(text),
            SimulationError::Sample(_) | SimulationError::Body(_) => {
                SceneError::new_err((text.clone(), vec![text]))
            }
            SimulationError::Count { .. }
            | SimulationError::NotFinite { .. }
            | SimulationError::OutsideDomain { .. } => ArrayError::new_err(text),
            SimulationError::BadDuration { .. } => ParameterError::new_err(text),
            _ => classes::SimulationError::new_err(text),
        })
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        let text = error.to_string();
        Self(match error {
            RunError::Simulation(error) => return error.into(),
            RunError::Checkpoint(error) => return error.into(),
            RunError::Gpu(_) | RunError::Render(_) => classes::DeviceError::new_err(text),
            RunError::SurfaceRequired | RunError::AlreadyFinished { .. } | RunError::Input(_) => {
                ParameterError::new_err(text)
            }
            RunError::NothingToResume { .. }
            | RunError::NoCheckpoint { .. }
            | RunError::NoUsableCheckpoint { .. } => classes::CheckpointError::new_err(text),
            _ => classes::FileError::new_err(text),
        })
    }
}
