//! Particles.

use std::ops::Range;
use std::sync::Arc;

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{self, Input, memory_of, scalars_of, vectors_of};
use crate::errors::Result;

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
    #[pyo3(signature = (positions, *, velocities = None, densities = None, pressures = None, ids = None))]
    fn new(
        positions: &Bound<'_, PyAny>,
        velocities: Option<&Bound<'_, PyAny>>,
        densities: Option<&Bound<'_, PyAny>>,
        pressures: Option<&Bound<'_, PyAny>>,
        ids: Option<&Bound<'_, PyAny>>,
    ) -> Result<Self> {
        let positions = arrays::vectors("positions", positions)?;
        let velocities = velocities.map(|value| arrays::vectors("velocities", value)).transpose()?;
        let scalars = |name, value: Option<_>| value.map(|value| arrays::scalars(name, value)).transpose();
        let (densities, pressures) = (scalars("densities", densities)?, scalars("pressures", pressures)?);
        let ids = ids.map(|value| arrays::integers("ids", value, None)).transpose()?;
        if let Some(velocities) = &velocities {
            velocities.is_apart_from(&positions)?;
        }
        if let (Some(densities), Some(pressures)) = (&densities, &pressures) {
            pressures.is_apart_from(densities)?;
        }
        let particles = splashdown::Particles::from_positions(positions.values)
            .with_velocities(velocities.map_or(Vec::new(), |input| input.values))
            .with_densities(densities.map_or(Vec::new(), |input: Input<f32>| input.values))
            .with_pressures(pressures.map_or(Vec::new(), |input| input.values))
            .with_ids(ids.map_or(Vec::new(), |input| input.values));
        particles.check().map_err(|error| crate::errors::ArrayError::new_err(error.to_string()))?;
        Ok(Self(Arc::new(particles)))
    }

    /// Positions, (N, 3) float32, m.
    #[getter]
    fn positions(this: Bound<'_, Self>) -> Result<Bound<'_, PyArray2<f32>>> {
        // SAFETY: the particles are immutable and owned by `this`; so in the getters below.
        unsafe { vectors_of(this.clone().into_any(), &this.get().0.positions) }
    }

    /// Velocities, (N, 3) float32, m/s.
    #[getter]
    fn velocities(this: Bound<'_, Self>) -> Result<Bound<'_, PyArray2<f32>>> {
        // SAFETY: see `positions`.
        unsafe { vectors_of(this.clone().into_any(), &this.get().0.velocities) }
    }

    /// Densities, (N,) float32, kg/m^3.
    #[getter]
    fn densities(this: Bound<'_, Self>) -> Result<Bound<'_, PyArray1<f32>>> {
        // SAFETY: see `positions`.
        unsafe { scalars_of(this.clone().into_any(), &this.get().0.densities) }
    }

    /// Pressures, (N,) float32, Pa.
    #[getter]
    fn pressures(this: Bound<'_, Self>) -> Result<Bound<'_, PyArray1<f32>>> {
        // SAFETY: see `positions`.
        unsafe { scalars_of(this.clone().into_any(), &this.get().0.pressures) }
    }

    /// Numbers that identify a particle in all frames, (N,) uint32.
    #[getter]
    fn ids(this: Bound<'_, Self>) -> Result<Bound<'_, PyArray1<u32>>> {
        // SAFETY: see `positions`.
        unsafe { scalars_of(this.clone().into_any(), &this.get().0.ids) }
    }

    /// All attributes of the file that the particles were read from, by name: (N,) or (N, 3) float32.
    #[getter]
    fn attributes(this: Bound<'_, Self>) -> Result<Bound<'_, PyDict>> {
        let found = PyDict::new(this.py());
        for attribute in &this.get().0.attributes {
            let owner = this.clone().into_any();
            if attribute.components == 3 {
                // SAFETY: see `positions`.
                let values =
                    unsafe { vectors_of(owner, bytemuck::cast_slice::<f32, [f32; 3]>(&attribute.values)) }?;
                found.set_item(&attribute.name, values)?;
            } else {
                // SAFETY: see `positions`.
                let values = unsafe { scalars_of(owner, &attribute.values) }?;
                found.set_item(&attribute.name, values)?;
            }
        }
        Ok(found)
    }

    fn __len__(&self) -> usize {
        self.0.len()
    }

    fn __repr__(&self) -> String {
        format!("Particles({} particles)", self.0.len())
    }
}
