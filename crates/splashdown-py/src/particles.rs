//! Particles.

use std::ops::Range;
use std::sync::Arc;

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Inputs, Owner, attributes_of, memory_of, scalars_of, vectors_of};
use crate::errors::{ArrayError, Result};

/// Particles in host memory; immutable. Attributes that are absent are arrays of length 0.
///
/// Arrays that are given must be C-contiguous, finite, of float32 (float64 is converted), and must not share memory; they are
/// copied. Arrays that are returned are read-only views without a copy and keep the particles alive.
///
/// >>> particles = splashdown.Particles(numpy.zeros((10, 3), numpy.float32))
/// >>> len(particles), particles.positions.shape, len(particles.velocities)
/// (10, (10, 3), 0)
#[pyclass(frozen, module = "splashdown")]
pub struct Particles(pub Arc<splashdown::Particles>);

// SAFETY: the particles are immutable.
unsafe impl Owner for Particles {}

impl Particles {
    /// The names and addresses of the vectors.
    pub fn memory(&self) -> [(&'static str, Range<usize>); 2] {
        [
            ("the positions of this simulation", memory_of(&self.0.positions)),
            ("the velocities of this simulation", memory_of(&self.0.velocities)),
        ]
    }
}

#[pymethods]
impl Particles {
    #[new]
    #[pyo3(signature = (positions, *, velocities = None, densities = None, pressures = None, ids = None, time = None, particle_spacing = None))]
    fn new(
        positions: &Bound<'_, PyAny>,
        velocities: Option<&Bound<'_, PyAny>>,
        densities: Option<&Bound<'_, PyAny>>,
        pressures: Option<&Bound<'_, PyAny>>,
        ids: Option<&Bound<'_, PyAny>>,
        time: Option<f64>,
        particle_spacing: Option<f32>,
    ) -> Result<Self> {
        let mut inputs = Inputs::default();
        let mut particles =
            splashdown::Particles::from_positions(inputs.vectors("positions", Some(positions))?)
                .with_velocities(inputs.vectors("velocities", velocities)?)
                .with_densities(inputs.scalars("densities", densities)?)
                .with_pressures(inputs.scalars("pressures", pressures)?)
                .with_ids(inputs.integers("ids", ids, None)?);
        (particles.info.time, particles.info.particle_spacing) = (time, particle_spacing);
        particles.check().map_err(|error| ArrayError::new_err(error.to_string()))?;
        Ok(Self(Arc::new(particles)))
    }

    /// Positions, (N, 3) float32, m.
    ///
    /// >>> frame.particles.positions.shape == (len(frame.particles), 3)
    /// True
    #[getter]
    fn positions<'py>(this: &Bound<'py, Self>) -> Result<Bound<'py, PyArray2<f32>>> {
        vectors_of(this, |particles| &particles.0.positions)
    }

    /// Velocities, (N, 3) float32, m/s.
    ///
    /// >>> bool((frame.particles.velocities == 0).all())  # at rest in frame 0
    /// True
    #[getter]
    fn velocities<'py>(this: &Bound<'py, Self>) -> Result<Bound<'py, PyArray2<f32>>> {
        vectors_of(this, |particles| &particles.0.velocities)
    }

    /// Densities, (N,) float32, kg/m^3.
    ///
    /// >>> stats = simulation.advance(0.01)
    /// >>> bool(abs(simulation.particles.densities.mean() - 1000) < 100)  # kg/m^3
    /// True
    #[getter]
    fn densities<'py>(this: &Bound<'py, Self>) -> Result<Bound<'py, PyArray1<f32>>> {
        scalars_of(this, |particles| &particles.0.densities)
    }

    /// Pressures, (N,) float32, Pa.
    ///
    /// >>> stats = simulation.advance(0.01)
    /// >>> bool(simulation.particles.pressures.max() > 0)  # Pa
    /// True
    #[getter]
    fn pressures<'py>(this: &Bound<'py, Self>) -> Result<Bound<'py, PyArray1<f32>>> {
        scalars_of(this, |particles| &particles.0.pressures)
    }

    /// Numbers that identify a particle in all frames, (N,) uint32.
    ///
    /// >>> frame.particles.ids[:3].tolist()
    /// [0, 1, 2]
    #[getter]
    fn ids<'py>(this: &Bound<'py, Self>) -> Result<Bound<'py, PyArray1<u32>>> {
        scalars_of(this, |particles| &particles.0.ids)
    }

    /// Simulated time in s; `None` if it is not known. Files of particles contain it.
    ///
    /// >>> frame.particles.time == frame.time
    /// True
    #[getter]
    fn time(&self) -> Option<f64> {
        self.0.info.time
    }

    /// Particle spacing in m; `None` if it is not known. Files of particles contain it.
    ///
    /// >>> size = splashdown.write_particles(folder / "state.npz", frame.particles)
    /// >>> splashdown.read_particles(folder / "state.npz").particle_spacing == frame.particles.particle_spacing
    /// True
    #[getter]
    fn particle_spacing(&self) -> Option<f32> {
        self.0.info.particle_spacing
    }

    /// All attributes of the file that the particles were read from, by name: (N,) or (N, 3) float32.
    ///
    /// >>> size = splashdown.write_particles(folder / "state.vtu", frame.particles)
    /// >>> sorted(splashdown.read_particles(folder / "state.vtu").attributes)
    /// ['density', 'id', 'pressure', 'velocity']
    #[getter]
    fn attributes<'py>(this: &Bound<'py, Self>) -> Result<Bound<'py, PyDict>> {
        attributes_of(this, |particles| &particles.0.attributes)
    }

    fn __len__(&self) -> usize {
        self.0.len()
    }

    fn __repr__(&self) -> String {
        format!("Particles({} particles)", self.0.len())
    }
}
