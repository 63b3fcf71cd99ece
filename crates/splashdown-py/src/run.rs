//! Runs: all frames of a scene.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use splashdown::{Event, RunOptions};

use crate::bodies::Body;
use crate::busy::Guarded;
use crate::checkpoint::Checkpoint;
use crate::errors::Result;
use crate::foam::Foam;
use crate::mesh::Mesh;
use crate::particles::Particles;
use crate::progress::Reporter;
use crate::scene::Scene;
use crate::simulation::{probes, warn};
use crate::stats::Stats;
use crate::surface::parse_device;

/// Computes the frames of a scene: an iterator over `Frame`. Frame 0 is the initial state. `surface` and `foam` override the
/// scene, and `frames` its number of frames.
///
/// Ctrl-C raises `KeyboardInterrupt`; `checkpoint` still works then, and the iteration can be continued.
///
/// >>> for frame in splashdown.Run(scene, device="cpu", frames=2):
/// ...     print(frame.index, round(frame.time, 3), frame.mesh.is_watertight)  # time in s
/// 0 0.0 True
/// 1 0.02 True
/// 2 0.04 True
#[pyclass(frozen, module = "splashdown")]
pub struct Run {
    state: Guarded<State>,
    scene: splashdown::Scene,
    reporter: Reporter,
    first_frame: u32,
    frames: u32,
}

struct State {
    run: splashdown::Run,
    bodies: Vec<String>,
}

/// Keyword arguments of a run.
struct Options<'a> {
    device: &'a str,
    frames: Option<u32>,
    surface: Option<bool>,
    foam: Option<bool>,
}

impl Options<'_> {
    fn of(&self, scene: &splashdown::Scene) -> Result<RunOptions> {
        let mut options = RunOptions::new(scene).with_device(parse_device(self.device)?);
        options.frames = self.frames;
        options.surface = self.surface.unwrap_or(options.surface);
        options.foam = self.foam.unwrap_or(options.foam);
        Ok(options)
    }
}

impl Run {
    fn of(run: splashdown::Run, scene: &splashdown::Scene, frames: Option<u32>, reporter: Reporter) -> Self {
        let bodies = run.bodies().iter().map(|body| body.name.clone()).collect();
        Self {
            first_frame: run.first_frame(),
            frames: frames.unwrap_or_else(|| scene.frame_count()),
            state: Guarded::new("run", State { run, bodies }),
            scene: scene.clone(),
            reporter,
        }
    }
}

#[pymethods]
impl Run {
    #[new]
    #[pyo3(signature = (scene, *, device = "auto", frames = None, surface = None, foam = None, progress = None))]
    fn new(
        py: Python<'_>,
        scene: &Bound<'_, Scene>,
        device: &str,
        frames: Option<u32>,
        surface: Option<bool>,
        foam: Option<bool>,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> Result<Self> {
        let (scene, reporter) = (&scene.get().0, Reporter::new(progress)?);
        warn(py, &scene.warnings.iter().map(ToString::to_string).collect::<Vec<_>>())?;
        let options = Options { device, frames, surface, foam }.of(scene)?;
        let run = py.detach(|| splashdown::Run::new(scene, options))?;
        Ok(Self::of(run, scene, frames, reporter))
    }

    /// Continues from a checkpoint, or from the path of one. Earlier frames are not returned again.
    ///
    /// >>> run = splashdown.Run(scene, device="cpu", frames=2)
    /// >>> first, second = next(run), next(run)
    /// >>> [frame.index for frame in splashdown.Run.resume(run.checkpoint(), device="cpu", frames=2)]
    /// [2]
    #[staticmethod]
    #[pyo3(signature = (checkpoint, *, device = "auto", frames = None, surface = None, foam = None, progress = None))]
    fn resume(
        checkpoint: &Bound<'_, PyAny>,
        device: &str,
        frames: Option<u32>,
        surface: Option<bool>,
        foam: Option<bool>,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> Result<Self> {
        let (py, reporter) = (checkpoint.py(), Reporter::new(progress)?);
        let checkpoint = Checkpoint::extract(checkpoint)?;
        let scene = checkpoint.scene()?;
        let options = Options { device, frames, surface, foam }.of(&scene)?;
        let run = py.detach(|| splashdown::Run::resume(&checkpoint, &scene, options))?;
        Ok(Self::of(run, &scene, frames, reporter))
    }

    fn __iter__(this: Py<Self>) -> Py<Self> {
        this
    }

    fn __next__(&self, py: Python<'_>) -> Result<Option<Frame>> {
        let mut taken = self.state.take()?;
        let State { run, bodies } = taken.get();
        loop {
            match py.detach(|| run.next()).transpose()? {
                None => {
                    self.reporter.close(py)?;
                    return Ok(None);
                }
                Some(Event::Frame(frame)) => {
                    py.check_signals()?;
                    return Ok(Some(Frame::new(py, frame, &self.scene, bodies)?));
                }
                Some(Event::Progress(progress)) => self.reporter.report(py, (&progress).into())?,
                Some(Event::Warning(text)) => warn(py, &[text])?,
                Some(_) => {}
            }
        }
    }

    /// The state after the last frame, from which `resume` continues with the same bits.
    ///
    /// >>> run = splashdown.Run(scene, device="cpu", frames=1)
    /// >>> frame = next(run)
    /// >>> run.checkpoint().time == frame.time  # s
    /// True
    fn checkpoint(&self, py: Python<'_>) -> Result<Checkpoint> {
        let mut taken = self.state.take()?;
        let run = &mut taken.get().run;
        Ok(Checkpoint::new(py.detach(|| run.checkpoint())?))
    }

    /// The scene.
    #[getter]
    fn scene(&self) -> Scene {
        Scene(self.scene.clone())
    }

    /// The frame at the start: 0, or that of the checkpoint.
    #[getter]
    fn first_frame(&self) -> u32 {
        self.first_frame
    }

    /// The number of the last frame.
    #[getter]
    fn frames(&self) -> u32 {
        self.frames
    }

    /// Whether `close` was called.
    #[getter]
    fn closed(&self) -> bool {
        self.state.is_closed()
    }

    /// Frees the memory of the device. Frames stay valid.
    ///
    /// >>> run = splashdown.Run(scene, device="cpu")
    /// >>> run.close()
    /// >>> run.closed
    /// True
    fn close(&self, py: Python<'_>) -> Result<()> {
        self.reporter.close(py)?;
        self.state.close()
    }

    fn __enter__(this: Py<Self>) -> Py<Self> {
        this
    }

    #[pyo3(signature = (*_exception))]
    fn __exit__(&self, py: Python<'_>, _exception: &Bound<'_, pyo3::types::PyTuple>) -> Result<()> {
        self.close(py)
    }

    fn __repr__(&self) -> String {
        format!("Run({:?}, frames {} to {})", self.scene.name, self.first_frame, self.frames)
    }
}

/// A complete frame. Its arrays stay valid after the run.
///
/// >>> frame = next(splashdown.Run(scene, device="cpu", surface=False))
/// >>> frame.index, frame.particles.positions.shape[1], frame.mesh
/// (0, 3, None)
#[pyclass(frozen, get_all, module = "splashdown")]
pub struct Frame {
    /// Its number, from 0.
    index: u32,
    /// Simulated time in s.
    time: f64,
    /// The particles in the order of their ids.
    particles: Py<Particles>,
    /// The surface, if enabled.
    mesh: Option<Py<Mesh>>,
    /// The volume that the surface encloses in m^3.
    volume: Option<f64>,
    /// Foam, spray and bubbles, if enabled.
    foam: Option<Py<Foam>>,
    /// The bodies in the order of the scene.
    bodies: Vec<Py<Body>>,
    /// The rows of each probe since the previous frame.
    probes: Py<PyDict>,
    /// Statistics.
    stats: Py<Stats>,
}

impl Frame {
    fn new(
        py: Python<'_>,
        frame: splashdown::run::Frame,
        scene: &splashdown::Scene,
        bodies: &[String],
    ) -> Result<Self> {
        let states = bodies.iter().zip(frame.bodies.iter());
        Ok(Self {
            index: frame.index,
            time: frame.time,
            particles: Py::new(py, Particles(Arc::clone(&frame.particles)))?,
            mesh: frame.mesh.map(|mesh| Py::new(py, Mesh(mesh))).transpose()?,
            volume: frame.volume,
            foam: frame.foam.map(|foam| Py::new(py, Foam::new(foam))).transpose()?,
            bodies: states
                .map(|(name, state)| Py::new(py, Body::new(name, state)))
                .collect::<PyResult<_>>()?,
            probes: probes(py, scene, &frame.probes)?.unbind(),
            stats: Py::new(py, Stats::from(frame.stats))?,
        })
    }
}

#[pymethods]
impl Frame {
    fn __repr__(&self, py: Python<'_>) -> String {
        let particles = self.particles.bind(py).get().0.len();
        format!("Frame({}, {:.4} s, {particles} particles)", self.index, self.time)
    }
}
