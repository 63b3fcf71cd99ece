//! Runs: all frames of a scene.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use splashdown::monitor::Level;
use splashdown::scene::OnBurst;
use splashdown::{Event, RunOptions};

use crate::argument::{whole, word};
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
/// The iteration raises `SimulationError` after a frame in which the fluid has burst; `on_burst` is "stop", "warn" or
/// "ignore". Ctrl-C raises `KeyboardInterrupt`; `checkpoint` still works then, and the iteration can be continued.
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
    warns_of_alarms: bool,
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
    on_burst: &'a str,
}

impl Options<'_> {
    fn of(&self, scene: &splashdown::Scene) -> Result<RunOptions> {
        let mut options = RunOptions::new(scene).with_device(parse_device(self.device)?);
        options.frames = self.frames;
        options.surface = self.surface.unwrap_or(options.surface);
        options.foam = self.foam.unwrap_or(options.foam);
        options.on_burst = word::<OnBurst>("on_burst", self.on_burst)?;
        Ok(options)
    }
}

impl Run {
    fn of(
        run: splashdown::Run,
        scene: &splashdown::Scene,
        frames: Option<u32>,
        reporter: Reporter,
        warns_of_alarms: bool,
    ) -> Self {
        let bodies = run.bodies().iter().map(|body| body.name.clone()).collect();
        Self {
            first_frame: run.first_frame(),
            frames: frames.unwrap_or_else(|| scene.frame_count()),
            state: Guarded::new("run", State { run, bodies }),
            scene: scene.clone(),
            reporter,
            warns_of_alarms,
        }
    }
}

#[pymethods]
impl Run {
    #[new]
    #[expect(clippy::too_many_arguments, reason = "they are keyword arguments in Python")]
    #[pyo3(signature = (scene, *, device = "auto", frames = None, surface = None, foam = None, on_burst = "stop", progress = None))]
    fn new(
        py: Python<'_>,
        scene: &Bound<'_, Scene>,
        device: &str,
        frames: Option<i64>,
        surface: Option<bool>,
        foam: Option<bool>,
        on_burst: &str,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> Result<Self> {
        let (scene, reporter) = (&scene.get().0, Reporter::new(progress)?);
        warn(py, &scene.warnings.iter().map(ToString::to_string).collect::<Vec<_>>())?;
        let frames = whole("frames", frames, 0)?;
        let options = Options { device, frames, surface, foam, on_burst }.of(scene)?;
        let warns_of_alarms = options.on_burst != OnBurst::Ignore;
        let run = py.detach(|| splashdown::Run::new(scene, options))?;
        Ok(Self::of(run, scene, frames, reporter, warns_of_alarms))
    }

    /// Continues from a checkpoint, or from the path of one. Earlier frames are not returned again.
    ///
    /// >>> run = splashdown.Run(scene, device="cpu", frames=2)
    /// >>> first, second = next(run), next(run)
    /// >>> [frame.index for frame in splashdown.Run.resume(run.checkpoint(), device="cpu", frames=2)]
    /// [2]
    #[staticmethod]
    #[pyo3(signature = (checkpoint, *, device = "auto", frames = None, surface = None, foam = None, on_burst = "stop", progress = None))]
    fn resume(
        checkpoint: &Bound<'_, PyAny>,
        device: &str,
        frames: Option<i64>,
        surface: Option<bool>,
        foam: Option<bool>,
        on_burst: &str,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> Result<Self> {
        let (py, reporter) = (checkpoint.py(), Reporter::new(progress)?);
        let checkpoint = Checkpoint::extract(checkpoint)?;
        let scene = checkpoint.scene()?;
        let frames = whole("frames", frames, 0)?;
        let options = Options { device, frames, surface, foam, on_burst }.of(&scene)?;
        let warns_of_alarms = options.on_burst != OnBurst::Ignore;
        let run = py.detach(|| splashdown::Run::resume(&checkpoint, &scene, options))?;
        Ok(Self::of(run, &scene, frames, reporter, warns_of_alarms))
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
                Some(Event::Alarm(alarm)) if self.warns_of_alarms && alarm.level >= Level::Warning => {
                    warn(py, &[alarm.message])?
                }
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
    ///
    /// >>> splashdown.Run(scene, device="cpu").scene == scene
    /// True
    #[getter]
    fn scene(&self) -> Scene {
        Scene(self.scene.clone())
    }

    /// The frame at the start: 0, or that of the checkpoint.
    ///
    /// >>> splashdown.Run(scene, device="cpu").first_frame
    /// 0
    #[getter]
    fn first_frame(&self) -> u32 {
        self.first_frame
    }

    /// The number of the last frame.
    ///
    /// >>> splashdown.Run(scene, device="cpu", frames=7).frames
    /// 7
    #[getter]
    fn frames(&self) -> u32 {
        self.frames
    }

    /// Whether `close` was called.
    ///
    /// >>> with splashdown.Run(scene, device="cpu") as run:
    /// ...     first = next(run)
    /// >>> run.closed
    /// True
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
    ///
    /// >>> frame.index
    /// 0
    index: u32,
    /// Simulated time in s.
    ///
    /// >>> frame.time  # s
    /// 0.0
    pub time: f64,
    /// The particles in the order of their ids.
    ///
    /// >>> len(frame.particles)
    /// 120
    pub particles: Py<Particles>,
    /// The surface, if enabled.
    ///
    /// >>> frame.mesh.is_watertight
    /// True
    pub mesh: Option<Py<Mesh>>,
    /// The isolated particles, which are not part of the surface, if that is enabled: ids, positions and velocities.
    ///
    /// >>> len(frame.droplets)
    /// 0
    pub droplets: Option<Py<Particles>>,
    /// The volume that the surface encloses, plus that of the droplets, in m^3.
    ///
    /// >>> frame.volume == frame.mesh.volume  # m^3, without droplets
    /// True
    volume: Option<f64>,
    /// Foam, spray and bubbles, if enabled.
    ///
    /// >>> frame.foam
    /// Foam(0 particles)
    pub foam: Option<Py<Foam>>,
    /// The bodies in the order of the scene.
    ///
    /// >>> [body.name for body in frame.bodies]
    /// ['crate']
    pub bodies: Vec<Py<Body>>,
    /// The rows of each probe since the previous frame.
    ///
    /// >>> first, second = splashdown.Run(scene, device="cpu", frames=1)
    /// >>> scene.probe_columns["gauge"], second.probes["gauge"].shape[1]
    /// (['time (s)', 'height (m)'], 2)
    probes: Py<PyDict>,
    /// Statistics.
    ///
    /// >>> frame.stats.particles == len(frame.particles)
    /// True
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
            droplets: frame.droplets.map(|droplets| Py::new(py, Particles(droplets))).transpose()?,
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
