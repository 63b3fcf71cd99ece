//! Foam, spray and bubbles.

use std::sync::Arc;

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use splashdown::foam::DiffuseParticles;

use crate::arrays::{scalars_of, vectors_of};
use crate::errors::Result;

/// Foam, spray and bubbles: diffuse particles, in host memory; immutable.
///
/// >>> wild = splashdown.Scene.preset("dam-break-small").replace({"foam.enabled": True})
/// >>> *_, last = splashdown.Run(wild, device="cpu", frames=2, surface=False)
/// >>> last.foam.positions.shape[1], last.foam.kinds.dtype.name
/// (3, 'uint8')
#[pyclass(frozen, module = "splashdown")]
pub struct Foam {
    particles: Arc<DiffuseParticles>,
    kinds: Vec<u8>,
}

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
    #[getter]
    fn positions(this: Bound<'_, Self>) -> Result<Bound<'_, PyArray2<f32>>> {
        // SAFETY: the particles are immutable and owned by `this`; so in the getters below.
        unsafe { vectors_of(this.clone().into_any(), &this.get().particles.positions) }
    }

    /// Velocities, (N, 3) float32, m/s.
    #[getter]
    fn velocities(this: Bound<'_, Self>) -> Result<Bound<'_, PyArray2<f32>>> {
        // SAFETY: see `positions`.
        unsafe { vectors_of(this.clone().into_any(), &this.get().particles.velocities) }
    }

    /// Remaining lifetimes as foam, (N,) float32, s.
    #[getter]
    fn lifetimes(this: Bound<'_, Self>) -> Result<Bound<'_, PyArray1<f32>>> {
        // SAFETY: see `positions`.
        unsafe { scalars_of(this.clone().into_any(), &this.get().particles.lifetimes) }
    }

    /// Numbers in the order of generation, (N,) uint32.
    #[getter]
    fn ids(this: Bound<'_, Self>) -> Result<Bound<'_, PyArray1<u32>>> {
        // SAFETY: see `positions`.
        unsafe { scalars_of(this.clone().into_any(), &this.get().particles.ids) }
    }

    /// 0 for spray, 1 for foam, 2 for bubbles, (N,) uint8.
    #[getter]
    fn kinds(this: Bound<'_, Self>) -> Result<Bound<'_, PyArray1<u8>>> {
        // SAFETY: see `positions`.
        unsafe { scalars_of(this.clone().into_any(), &this.get().kinds) }
    }

    fn __len__(&self) -> usize {
        self.kinds.len()
    }

    fn __repr__(&self) -> String {
        format!("Foam({} particles)", self.kinds.len())
    }
}
