//! Foam, spray and bubbles.

use std::sync::Arc;

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use splashdown::foam::DiffuseParticles;

use crate::arrays::{Owner, scalars_of, vectors_of};
use crate::errors::Result;

/// Foam, spray and bubbles: diffuse particles, in host memory; immutable.
///
/// >>> stats = simulation.advance(0.01)  # `foam.enabled` is true in this scene
/// >>> len(simulation.foam) == len(simulation.foam.positions)
/// True
#[pyclass(frozen, module = "splashdown")]
pub struct Foam {
    pub particles: Arc<DiffuseParticles>,
    kinds: Vec<u8>,
}

// SAFETY: the particles and their kinds are immutable.
unsafe impl Owner for Foam {}

impl Foam {
    /// Wraps diffuse particles.
    pub fn new(particles: Arc<DiffuseParticles>) -> Self {
        let kinds = particles.kinds.iter().map(|&kind| kind as u8).collect();
        Self { particles, kinds }
    }
}

#[pymethods]
impl Foam {
    /// Positions, (N, 3) float32, m.
    ///
    /// >>> frame.foam.positions.shape[1]
    /// 3
    #[getter]
    fn positions<'py>(this: &Bound<'py, Self>) -> Result<Bound<'py, PyArray2<f32>>> {
        vectors_of(this, |foam| &foam.particles.positions)
    }

    /// Velocities, (N, 3) float32, m/s.
    ///
    /// >>> frame.foam.velocities.shape == frame.foam.positions.shape
    /// True
    #[getter]
    fn velocities<'py>(this: &Bound<'py, Self>) -> Result<Bound<'py, PyArray2<f32>>> {
        vectors_of(this, |foam| &foam.particles.velocities)
    }

    /// Remaining lifetimes as foam, (N,) float32, s.
    ///
    /// >>> bool((frame.foam.lifetimes >= 0).all())  # s
    /// True
    #[getter]
    fn lifetimes<'py>(this: &Bound<'py, Self>) -> Result<Bound<'py, PyArray1<f32>>> {
        scalars_of(this, |foam| &foam.particles.lifetimes)
    }

    /// Numbers in the order of generation, (N,) uint32.
    ///
    /// >>> bool((numpy.diff(frame.foam.ids) > 0).all())
    /// True
    #[getter]
    fn ids<'py>(this: &Bound<'py, Self>) -> Result<Bound<'py, PyArray1<u32>>> {
        scalars_of(this, |foam| &foam.particles.ids)
    }

    /// 0 for spray, 1 for foam, 2 for bubbles, (N,) uint8.
    ///
    /// >>> spray = frame.foam.positions[frame.foam.kinds == 0]
    /// >>> frame.foam.kinds.dtype.name
    /// 'uint8'
    #[getter]
    fn kinds<'py>(this: &Bound<'py, Self>) -> Result<Bound<'py, PyArray1<u8>>> {
        scalars_of(this, |foam| &foam.kinds)
    }

    fn __len__(&self) -> usize {
        self.kinds.len()
    }

    fn __repr__(&self) -> String {
        format!("Foam({} particles)", self.kinds.len())
    }
}
