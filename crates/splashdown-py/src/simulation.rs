//! Simulations.

use std::sync::Arc;
use std::time::{Duration, Instant};

use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use splashdown::Device;

use crate::arrays;
use crate::bodies::Body;
use crate::busy::Guarded;
use crate::checkpoint::Checkpoint;
use crate::errors::{ArrayError, ParameterError, Result};
use crate::foam::Foam;
use crate::mesh::Mesh;
use crate::particles::Particles;
use crate::progress::{Progress, Reporter};
use crate::scene::Scene;
use crate::stats::Stats;
use crate::surface::parse_device;

/// Time between two checks for signals.
const PATIENCE: Duration = Duration::from_millis(50);

/// A running simulation of a scene on one device: "auto" (the best GPU, else the CPU), "gpu", "cpu", or part of the name of
/// an adapter. `particles` replaces the fluid of the scene; all must lie inside the domain.
///
/// One thread at a time may use it. Long calls release the interpreter lock. Ctrl-C during `advance` ends the frame at its
/// last step, so that the simulation can be read and continued. `close`, or the end of `with`, frees the device's memory;
/// arrays stay valid.
///
/// >>> with splashdown.Simulation(scene, device="cpu") as simulation:
/// ...     for _ in range(3):
/// ...         stats = simulation.advance(0.01)  # s
/// ...     highest = simulation.positions[:, 1].max()  # m
/// >>> bool(0 < highest < 1)
/// True
#[pyclass(frozen, module = "splashdown")]
pub struct Simulation(Guarded<State>);

struct State {
    simulation: splashdown::Simulation,
    foam: Option<splashdown::foam::Foam>,
    surface: Option<splashdown::Surface>,
    /// The particles now, once they have been read.
    particles: Option<Py<Particles>>,
}

impl State {
    fn new(mut simulation: splashdown::Simulation) -> Result<Self, splashdown::SimulationError> {
        let scene = simulation.scene();
        let settings = scene.foam.enabled.then_some(scene.foam);
        let foam = settings.map(|settings| simulation.foam(&settings)).transpose()?;
        Ok(Self { simulation, foam, surface: None, particles: None })
    }

    /// Extracts the surface with the settings of the scene.
    fn extracted(
        &mut self,
    ) -> Result<(&mut splashdown::Simulation, &splashdown::Surface), splashdown::SimulationError> {
        let Self { simulation, surface, .. } = self;
        let surface = match surface {
            Some(surface) => surface,
            None => {
                let settings = simulation.scene().surface.clone();
                surface.insert(simulation.surface(&settings)?)
            }
        };
        simulation.extract(surface)?;
        Ok((simulation, surface))
    }

    /// Simulates for a short time. Returns the statistics at the end of the frame, and the progress before.
    fn proceed(&mut self) -> Result<Option<splashdown::Stats>, splashdown::SimulationError> {
        let begun = Instant::now();
        loop {
            let done = self.simulation.continue_frame()?;
            if let Some(foam) = &self.foam {
                self.simulation.advance_foam(foam)?;
            }
            if done.is_some() || begun.elapsed() > PATIENCE {
                return Ok(done);
            }
        }
    }

    fn particles(&mut self, py: Python<'_>) -> Result<Py<Particles>> {
        if self.particles.is_none() {
            let particles = py.detach(|| self.simulation.particles())?;
            self.particles = Some(Py::new(py, Particles(Arc::new(particles)))?);
        }
        match &self.particles {
            Some(particles) => Ok(particles.clone_ref(py)),
            None => unreachable!("set above"),
        }
    }

    fn warn(&mut self, py: Python<'_>) -> Result<()> {
        let warnings = self.simulation.take_warnings();
        warn(py, &warnings)
    }
}

/// Issues warnings of the library as Python's warnings.
///
/// # Errors
/// If the user turns warnings into errors.
pub fn warn(py: Python<'_>, warnings: &[String]) -> Result<()> {
    if warnings.is_empty() {
        return Ok(());
    }
    let category = py.import("splashdown._errors")?.getattr("SimulationWarning")?;
    let issue = py.import("warnings")?.getattr("warn")?;
    for text in warnings {
        issue.call1((text, &category))?;
    }
    Ok(())
}

impl Simulation {
    fn of(simulation: splashdown::Simulation) -> Result<Self> {
        Ok(Self(Guarded::new("simulation", State::new(simulation)?)))
    }
}

#[pymethods]
impl Simulation {
    #[new]
    #[pyo3(signature = (scene, *, device = "auto", particles = None))]
    fn new(
        py: Python<'_>,
        scene: &Bound<'_, Scene>,
        device: &str,
        particles: Option<&Bound<'_, Particles>>,
    ) -> Result<Self> {
        let (scene, device) = (&scene.get().0, parse_device(device)?);
        let given = particles.map(|particles| Arc::clone(&particles.get().0));
        if let Some(given) = &given {
            check_inside(scene, given)?;
        }
        warn(py, &scene.warnings.iter().map(ToString::to_string).collect::<Vec<_>>())?;
        let simulation = py.detach(|| match given {
            Some(given) => {
                let executor = device.executor()?;
                splashdown::Simulation::with_particles(scene, executor, &given)
            }
            None => splashdown::Simulation::new(scene, &device),
        })?;
        Self::of(simulation)
    }

    /// Continues from a checkpoint, or from the path of one.
    ///
    /// >>> twin = splashdown.Simulation.resume(simulation.checkpoint(), device="cpu")
    /// >>> twin.time == simulation.time  # s
    /// True
    #[staticmethod]
    #[pyo3(signature = (checkpoint, *, device = "auto"))]
    fn resume(checkpoint: &Bound<'_, PyAny>, device: &str) -> Result<Self> {
        let (py, device) = (checkpoint.py(), parse_device(device)?);
        let checkpoint = Checkpoint::extract(checkpoint)?;
        let resumed = py.detach(|| {
            let simulation = splashdown::Simulation::resume(&checkpoint, device.executor()?)?;
            let mut state = State::new(simulation)?;
            if let (Some(foam), Some(kept)) = (&mut state.foam, checkpoint.foam()?) {
                state.simulation.restore_foam(foam, &kept)?;
            }
            Ok::<_, splashdown::SimulationError>(state)
        })?;
        Ok(Self(Guarded::new("simulation", resumed)))
    }

    /// Simulates `dt` seconds in as many steps as stability requires, and returns the statistics. `progress` is a function that
    /// receives `Progress`, or `True` for a bar of `tqdm` if that is installed.
    ///
    /// >>> simulation.advance(0.005).steps_in_frame > 0  # s
    /// True
    #[pyo3(signature = (dt, *, progress = None))]
    fn advance(&self, py: Python<'_>, dt: f32, progress: Option<&Bound<'_, PyAny>>) -> Result<Stats> {
        let reporter = Reporter::new(progress)?;
        let mut taken = self.0.take()?;
        let state = taken.get();
        let end = state.simulation.stats().time + f64::from(dt);
        // The particles of a simulation that has failed can still be read, so they are read again.
        state.particles = None;
        state.simulation.begin(dt)?;
        let stats = loop {
            if let Some(stats) = py.detach(|| state.proceed())? {
                break stats;
            }
            let (time, steps) = state.simulation.progress();
            let dt = state.simulation.dt();
            let now = Progress { time, duration: end, steps, dt, frame: 0, frames: 0 };
            if let Err(error) = reporter.report(py, now) {
                // The frame ends here, so that the simulation can be read and continued.
                py.detach(|| state.simulation.end_frame_early())?;
                reporter.close(py)?;
                return Err(error.into());
            }
        };
        reporter.close(py)?;
        py.check_signals()?;
        state.warn(py)?;
        Ok(stats.into())
    }

    /// The particles now, in the order of their ids.
    ///
    /// >>> len(simulation.particles) == len(simulation)
    /// True
    #[getter]
    fn particles(&self, py: Python<'_>) -> Result<Py<Particles>> {
        self.0.take()?.get().particles(py)
    }

    /// Positions, (N, 3) float32, m, read-only. Assign an array of the same shape to move the particles; all must lie inside
    /// the domain.
    ///
    /// >>> simulation.positions = simulation.positions + numpy.float32([0.1, 0, 0])  # m
    /// >>> round(float(simulation.positions[:, 0].min()), 2)  # m
    /// 0.15
    #[getter]
    fn positions<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        Ok(self.particles(py)?.bind(py).getattr("positions")?)
    }

    #[setter]
    fn set_positions(&self, positions: &Bound<'_, PyAny>) -> Result<()> {
        self.set("positions", positions, splashdown::Simulation::set_positions)
    }

    /// Velocities, (N, 3) float32, m/s, read-only. Assign an array of the same shape to change them.
    ///
    /// >>> velocities = simulation.velocities.copy()
    /// >>> velocities[:, 0] = 0.5  # m/s
    /// >>> simulation.velocities = velocities
    /// >>> stats = simulation.advance(0.01)
    /// >>> bool(simulation.velocities[:, 0].mean() > 0.3)  # m/s
    /// True
    #[getter]
    fn velocities<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        Ok(self.particles(py)?.bind(py).getattr("velocities")?)
    }

    #[setter]
    fn set_velocities(&self, velocities: &Bound<'_, PyAny>) -> Result<()> {
        self.set("velocities", velocities, splashdown::Simulation::set_velocities)
    }

    /// Densities at the beginning of the last step, (N,) float32, kg/m^3.
    ///
    /// >>> stats = simulation.advance(0.01)
    /// >>> bool(abs(simulation.densities.mean() - 1000) < 100)  # kg/m^3
    /// True
    #[getter]
    fn densities<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        Ok(self.particles(py)?.bind(py).getattr("densities")?)
    }

    /// Pressures at the beginning of the last step, (N,) float32, Pa.
    ///
    /// >>> stats = simulation.advance(0.01)
    /// >>> bool(simulation.pressures.max() > 0)  # Pa
    /// True
    #[getter]
    fn pressures<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        Ok(self.particles(py)?.bind(py).getattr("pressures")?)
    }

    /// Numbers that identify a particle at all times, (N,) uint32, ascending.
    ///
    /// >>> simulation.ids[:3].tolist()
    /// [0, 1, 2]
    #[getter]
    fn ids<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        Ok(self.particles(py)?.bind(py).getattr("ids")?)
    }

    /// Foam, spray and bubbles now, if the scene enables them, else `None`.
    ///
    /// >>> simulation.foam
    /// Foam(0 particles)
    /// >>> splashdown.Simulation(scene.replace({"foam.enabled": False}), device="cpu").foam is None
    /// True
    #[getter]
    fn foam(&self, py: Python<'_>) -> Result<Option<Foam>> {
        let mut taken = self.0.take()?;
        let State { simulation, foam, .. } = taken.get();
        let Some(foam) = foam else { return Ok(None) };
        let diffuse = py.detach(|| simulation.diffuse(foam))?;
        Ok(Some(Foam::new(Arc::new(diffuse))))
    }

    /// Reconstructs the surface of the fluid with the settings of the scene.
    ///
    /// >>> simulation.surface().volume > 0  # m^3
    /// True
    fn surface(&self, py: Python<'_>) -> Result<Mesh> {
        let mut taken = self.0.take()?;
        let state = taken.get();
        let mesh = py.detach(|| {
            let (simulation, surface) = state.extracted()?;
            simulation.mesh(surface)
        })?;
        Ok(Mesh(Arc::new(mesh)))
    }

    /// The isolated particles, which are not part of the surface, with the settings of the scene: ids, positions and
    /// velocities.
    ///
    /// >>> len(simulation.droplets())
    /// 0
    fn droplets(&self, py: Python<'_>) -> Result<Particles> {
        let mut taken = self.0.take()?;
        let state = taken.get();
        let droplets = py.detach(|| {
            let (simulation, surface) = state.extracted()?;
            simulation.droplets(surface)
        })?;
        Ok(Particles(Arc::new(droplets)))
    }

    /// The rows that the probes have measured since the last call, by the name of the probe: (rows, columns) float64, the first
    /// column is the time in s. `Scene.probe_columns` has the names and units of the columns.
    ///
    /// >>> stats = simulation.advance(0.02)
    /// >>> scene.probe_columns["gauge"], simulation.take_probes()["gauge"].shape[1]
    /// (['time (s)', 'height (m)'], 2)
    fn take_probes<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyDict>> {
        let mut taken = self.0.take()?;
        let simulation = &mut taken.get().simulation;
        let rows = simulation.take_probe_rows();
        probes(py, simulation.scene(), &rows)
    }

    /// The bodies of the scene now.
    ///
    /// >>> [body.name for body in simulation.bodies]
    /// ['crate']
    #[getter]
    fn bodies(&self, py: Python<'_>) -> Result<Vec<Body>> {
        let mut taken = self.0.take()?;
        let simulation = &mut taken.get().simulation;
        let states = py.detach(|| simulation.body_states())?;
        Ok(simulation
            .body_meshes()
            .iter()
            .zip(&states)
            .map(|(body, state)| Body::new(&body.name, state))
            .collect())
    }

    /// The repaired mesh of a body in its own frame, in m: rotate it by `Body.orientation`, then move it by `Body.position`.
    ///
    /// >>> mesh = simulation.body_mesh("crate")
    /// >>> bool((mesh.vertices + numpy.float32(simulation.bodies[0].position)).max() < 1.2)  # m
    /// True
    fn body_mesh(&self, name: &str) -> Result<Mesh> {
        let mut taken = self.0.take()?;
        let meshes = taken.get().simulation.body_meshes();
        match meshes.iter().find(|body| body.name == name) {
            Some(body) => Ok(Mesh(Arc::clone(&body.mesh))),
            None => {
                let names: Vec<_> = meshes.iter().map(|body| format!("{:?}", body.name)).collect();
                let message = format!("the scene has no body {name:?}; it has [{}]", names.join(", "));
                Err(ParameterError::new_err(message).into())
            }
        }
    }

    /// The state now, from which `resume` continues.
    ///
    /// >>> simulation.checkpoint().time == simulation.time  # s
    /// True
    fn checkpoint(&self, py: Python<'_>) -> Result<Checkpoint> {
        let mut taken = self.0.take()?;
        let State { simulation, foam, .. } = taken.get();
        let text = Arc::clone(&simulation.scene().text);
        let checkpoint = py.detach(|| {
            let mut checkpoint = simulation.checkpoint(&text)?;
            if let Some(foam) = foam {
                checkpoint.set_foam(&splashdown_gpu::block_on(simulation.keep_foam_async(foam))?);
            }
            Ok::<_, splashdown::SimulationError>(checkpoint)
        })?;
        Ok(Checkpoint::new(checkpoint))
    }

    /// The statistics at the end of the last `advance`.
    ///
    /// >>> simulation.stats.particles, simulation.stats.steps
    /// (120, 0)
    #[getter]
    fn stats(&self) -> Result<Stats> {
        Ok(self.0.take()?.get().simulation.stats().into())
    }

    /// The scene.
    ///
    /// >>> simulation.scene == scene
    /// True
    #[getter]
    fn scene(&self) -> Result<Scene> {
        Ok(Scene(self.0.take()?.get().simulation.scene().clone()))
    }

    /// Simulated time in s.
    ///
    /// >>> stats = simulation.advance(0.01)
    /// >>> round(simulation.time, 4)  # s
    /// 0.01
    #[getter]
    fn time(&self) -> Result<f64> {
        Ok(self.0.take()?.get().simulation.stats().time)
    }

    /// The last stable time step in s.
    ///
    /// >>> bool(0 < simulation.dt <= 0.05)  # s
    /// True
    #[getter]
    fn dt(&self) -> Result<f32> {
        Ok(self.0.take()?.get().simulation.dt())
    }

    /// The name of the device.
    ///
    /// >>> simulation.device.split(" ")[0]
    /// 'CPU'
    #[getter]
    fn device(&self) -> Result<String> {
        Ok(self.0.take()?.get().simulation.device_name())
    }

    /// The size of all buffers of the device in bytes.
    ///
    /// >>> simulation.memory > 92 * len(simulation)  # bytes
    /// True
    #[getter]
    fn memory(&self) -> Result<u64> {
        Ok(self.0.take()?.get().simulation.memory())
    }

    /// Whether `close` was called.
    ///
    /// >>> with simulation:
    /// ...     stats = simulation.advance(0.01)
    /// >>> simulation.closed
    /// True
    #[getter]
    fn closed(&self) -> bool {
        self.0.is_closed()
    }

    /// Frees the memory of the device. Arrays that were read stay valid.
    ///
    /// >>> other = splashdown.Simulation(scene, device="cpu")
    /// >>> other.close()
    /// >>> other.closed
    /// True
    fn close(&self) -> Result<()> {
        self.0.close()
    }

    fn __len__(&self) -> Result<usize> {
        Ok(self.0.take()?.get().simulation.stats().particles as usize)
    }

    fn __enter__(this: Py<Self>) -> Py<Self> {
        this
    }

    #[pyo3(signature = (*_exception))]
    fn __exit__(&self, _exception: &Bound<'_, pyo3::types::PyTuple>) -> Result<()> {
        self.close()
    }

    fn __repr__(&self) -> String {
        match self.0.take() {
            Ok(mut taken) => {
                let simulation = &taken.get().simulation;
                let stats = simulation.stats();
                format!(
                    "Simulation({:?}, {} particles at {:.4} s)",
                    simulation.scene().name,
                    stats.particles,
                    stats.time
                )
            }
            Err(_) if self.0.is_closed() => "Simulation(closed)".to_owned(),
            Err(_) => "Simulation(in use)".to_owned(),
        }
    }
}

type Set = fn(&mut splashdown::Simulation, &[[f32; 3]]) -> Result<(), splashdown::SimulationError>;

impl Simulation {
    /// Writes positions or velocities.
    fn set(&self, name: &'static str, values: &Bound<'_, PyAny>, set: Set) -> Result<()> {
        let input = arrays::vectors(name, values)?;
        let mut taken = self.0.take()?;
        let state = taken.get();
        if let Some(particles) = &state.particles {
            for (other, memory) in particles.get().memory() {
                // Writing back what was read changes nothing, and is allowed.
                if !other.contains(name) {
                    input.is_apart_from(other, &memory)?;
                }
            }
        }
        values.py().detach(|| set(&mut state.simulation, &input.values))?;
        state.particles = None;
        Ok(())
    }
}

/// The library removes particles outside the domain, as in a file; an array of them is a mistake.
fn check_inside(scene: &splashdown::Scene, particles: &splashdown::Particles) -> Result<()> {
    if particles.is_empty() {
        let message =
            "there are no particles: give at least one, or leave particles out to use the fluid of the scene";
        return Err(ArrayError::new_err(message).into());
    }
    let (min, max) = (scene.domain.min.to_array(), scene.domain.max.to_array());
    let is_outside = |x: &[f32; 3]| (0..3).any(|axis| !(min[axis]..=max[axis]).contains(&x[axis]));
    match particles.positions.iter().position(is_outside) {
        Some(index) => {
            let position = particles.positions[index];
            Err(splashdown::SimulationError::OutsideDomain { index, position, min, max }.into())
        }
        None => Ok(()),
    }
}

/// The rows of probes by name, each an array (rows, columns).
///
/// # Errors
/// If Python is out of memory.
pub fn probes<'py>(
    py: Python<'py>,
    scene: &splashdown::Scene,
    rows: &[Vec<Vec<f64>>],
) -> Result<Bound<'py, PyDict>> {
    let found = PyDict::new(py);
    for (probe, rows) in scene.probes.iter().zip(rows) {
        let columns = splashdown::probes::columns(probe).len();
        let flat: Vec<f64> = rows.concat();
        let shaped = numpy::ndarray::Array2::from_shape_vec((rows.len(), columns), flat)
            .map_err(|error| ArrayError::new_err(error.to_string()))?;
        found.set_item(&probe.name, PyArray2::from_owned_array(py, shaped))?;
    }
    Ok(found)
}

const _: fn() = || {
    fn is_send<T: Send>() {}
    is_send::<State>();
    is_send::<Device>();
};
