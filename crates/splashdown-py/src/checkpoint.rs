//! Checkpoints.

use std::path::PathBuf;
use std::sync::Mutex;

use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::errors::Result;
use crate::scene::Scene;

/// The state of a simulation or of a run. On the same kind of device it continues with the same bits. Can be pickled.
///
/// >>> simulation = splashdown.Simulation(scene, device="cpu")
/// >>> checkpoint = simulation.checkpoint()
/// >>> twin = splashdown.Simulation.resume(checkpoint, device="cpu")
/// >>> simulation.advance(0.01).steps == twin.advance(0.01).steps
/// True
/// >>> numpy.array_equal(simulation.positions, twin.positions)
/// True
#[pyclass(frozen, module = "splashdown")]
pub struct Checkpoint(Mutex<splashdown::Checkpoint>);

impl Checkpoint {
    /// Wraps a checkpoint.
    pub fn new(checkpoint: splashdown::Checkpoint) -> Self {
        Self(Mutex::new(checkpoint))
    }

    /// A copy.
    pub fn to_owned(&self) -> splashdown::Checkpoint {
        self.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner).clone()
    }

    /// A checkpoint, or the one in a file.
    ///
    /// # Errors
    /// `CheckpointError` if the file cannot be used; `TypeError` for anything else.
    pub fn extract(given: &Bound<'_, PyAny>) -> Result<splashdown::Checkpoint> {
        match given.cast::<Self>() {
            Ok(checkpoint) => Ok(checkpoint.get().to_owned()),
            Err(_) => {
                let path: PathBuf = given.extract()?;
                Ok(given.py().detach(|| splashdown::Checkpoint::read(&path))?)
            }
        }
    }
}

#[pymethods]
impl Checkpoint {
    /// Reads a file.
    ///
    /// >>> size = simulation.checkpoint().write(folder / "state.splashdown")
    /// >>> splashdown.Checkpoint.read(folder / "state.splashdown").time == simulation.time  # s
    /// True
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> Result<Self> {
        Ok(Self::new(py.detach(|| splashdown::Checkpoint::read(&path))?))
    }

    /// Reads the content of a file.
    ///
    /// >>> splashdown.Checkpoint.from_bytes(simulation.checkpoint().to_bytes()).scene == scene
    /// True
    #[staticmethod]
    fn from_bytes(data: &[u8]) -> Result<Self> {
        Ok(Self::new(splashdown::Checkpoint::from_bytes(data)?))
    }

    /// Writes a file, which is complete or absent, and returns its size in bytes. The usual ending is `.splashdown`.
    ///
    /// >>> simulation.checkpoint().write(folder / "copy.splashdown") > 1000
    /// True
    fn write(&self, py: Python<'_>, path: PathBuf) -> Result<u64> {
        let checkpoint = self.to_owned();
        Ok(py.detach(|| checkpoint.write(&path))?)
    }

    /// The content of a file.
    ///
    /// >>> simulation.checkpoint().to_bytes()[:2]  # a ZIP of NumPy arrays
    /// b'PK'
    fn to_bytes<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyBytes>> {
        let checkpoint = self.to_owned();
        Ok(PyBytes::new(py, &py.detach(|| checkpoint.to_bytes())?))
    }

    /// Simulated time in s.
    ///
    /// >>> stats = simulation.advance(0.01)
    /// >>> simulation.checkpoint().time == stats.time  # s
    /// True
    #[getter]
    fn time(&self) -> Result<f64> {
        Ok(self.to_owned().time()?)
    }

    /// The device that made it: "CPU" or the name of an adapter.
    ///
    /// >>> simulation.checkpoint().device
    /// 'CPU'
    #[getter]
    fn device(&self) -> Result<Option<String>> {
        Ok(self.to_owned().device()?)
    }

    /// The scene that is simulated.
    ///
    /// >>> simulation.checkpoint().scene == scene
    /// True
    #[getter]
    fn scene(&self) -> Result<Scene> {
        Ok(Scene(self.to_owned().scene()?))
    }

    /// A text of your own, stored in the file; `None` if there is none.
    ///
    /// >>> checkpoint = simulation.checkpoint()
    /// >>> checkpoint.notes = "before the gate opens"
    /// >>> splashdown.Checkpoint.from_bytes(checkpoint.to_bytes()).notes
    /// 'before the gate opens'
    #[getter]
    fn notes(&self) -> Option<String> {
        self.to_owned().notes().map(str::to_owned)
    }

    #[setter]
    fn set_notes(&self, text: &str) {
        self.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner).set_notes(text);
    }

    fn __reduce__<'py>(this: &Bound<'py, Self>) -> Result<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let restore = this.py().get_type::<Self>().getattr("from_bytes")?;
        Ok((restore, (this.get().to_bytes(this.py())?,)))
    }

    fn __repr__(&self) -> String {
        format!("Checkpoint(at {} s)", self.to_owned().time().unwrap_or(f64::NAN))
    }
}
