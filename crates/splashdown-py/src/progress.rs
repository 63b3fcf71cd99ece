//! Progress, reported to Python.

use pyo3::prelude::*;

use crate::errors::Result;

/// The progress of a simulation or of a run, which the function in the argument `progress` receives several times a second.
///
/// >>> seen = []
/// >>> stats = simulation.advance(0.02, progress=lambda now: seen.append(now.time))
/// >>> all(time <= simulation.time for time in seen)
/// True
#[pyclass(frozen, get_all, module = "splashdown")]
#[derive(Clone, Copy)]
pub struct Progress {
    /// Simulated time in s.
    ///
    /// >>> seen = []
    /// >>> stats = simulation.advance(0.1, progress=seen.append)
    /// >>> all(now.time <= stats.time for now in seen)  # s
    /// True
    pub time: f64,
    /// Simulated time at the end in s.
    ///
    /// >>> seen = []
    /// >>> stats = simulation.advance(0.1, progress=seen.append)
    /// >>> all(round(now.duration, 4) == 0.1 for now in seen)  # s
    /// True
    pub duration: f64,
    /// Steps since the start.
    ///
    /// >>> seen = []
    /// >>> stats = simulation.advance(0.1, progress=seen.append)
    /// >>> all(0 < now.steps <= stats.steps for now in seen)
    /// True
    pub steps: u64,
    /// The largest stable time step in s.
    ///
    /// >>> seen = []
    /// >>> stats = simulation.advance(0.1, progress=seen.append)
    /// >>> all(now.dt > 0 for now in seen)  # s
    /// True
    pub dt: f32,
    /// The frame being computed, from 1; 0 outside of a run.
    ///
    /// >>> seen = []
    /// >>> stats = simulation.advance(0.1, progress=seen.append)
    /// >>> all(now.frame == 0 for now in seen)
    /// True
    pub frame: u32,
    /// The number of frames; 0 outside of a run.
    ///
    /// >>> seen = []
    /// >>> stats = simulation.advance(0.1, progress=seen.append)
    /// >>> all(now.frames == 0 for now in seen)
    /// True
    pub frames: u32,
}

#[pymethods]
impl Progress {
    fn __repr__(&self) -> String {
        format!("Progress({:.4} s of {:.4} s, {} steps)", self.time, self.duration, self.steps)
    }
}

impl From<&splashdown::run::Progress> for Progress {
    fn from(progress: &splashdown::run::Progress) -> Self {
        let splashdown::run::Progress { frame, frames, time, duration, steps, dt, .. } = *progress;
        Self { time, duration, steps, dt, frame, frames }
    }
}

/// What reports progress: a function, or nothing.
pub struct Reporter(Option<Py<PyAny>>);

impl Reporter {
    /// From the argument `progress` of Python: `None` or `False`, `True` for a bar of `tqdm`, or a function.
    ///
    /// # Errors
    /// `TypeError` for anything else.
    pub fn new(given: Option<&Bound<'_, PyAny>>) -> Result<Self> {
        let Some(given) = given else { return Ok(Self(None)) };
        let function = given.py().import("splashdown._progress")?.call_method1("function", (given,))?;
        Ok(Self((!function.is_none()).then(|| function.unbind())))
    }

    /// Runs pending signal handlers, and reports progress.
    ///
    /// # Errors
    /// `KeyboardInterrupt` after Ctrl-C, or what the function raises.
    pub fn report(&self, py: Python<'_>, progress: Progress) -> PyResult<()> {
        py.check_signals()?;
        if let Some(function) = &self.0 {
            function.call1(py, (progress,))?;
        }
        Ok(())
    }

    /// Reports the end, so that a bar is closed.
    ///
    /// # Errors
    /// What the function raises.
    pub fn close(&self, py: Python<'_>) -> PyResult<()> {
        if let Some(function) = &self.0
            && let Some(close) = function.bind(py).getattr_opt("close")?
        {
            close.call0()?;
        }
        Ok(())
    }
}
