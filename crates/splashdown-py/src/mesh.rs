//! Triangle meshes.

use std::sync::Arc;

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{self, scalars_of, vectors_of};
use crate::errors::{ArrayError, Result};

/// A triangle mesh in host memory; immutable. Seen from outside, triangles are counter-clockwise.
///
/// Arrays that are given must be C-contiguous, finite, of float32 (float64 is converted) or of integers, and must not share
/// memory; they are copied. Arrays that are returned are read-only views without a copy and keep the mesh alive.
///
/// >>> corners = numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], numpy.float32)
/// >>> faces = numpy.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], numpy.uint32)
/// >>> mesh = splashdown.Mesh(corners, faces)
/// >>> round(mesh.volume, 4), mesh.is_watertight  # m^3
/// (0.1667, True)
#[pyclass(frozen, module = "splashdown")]
pub struct Mesh(pub Arc<splashdown::Mesh>);

#[pymethods]
impl Mesh {
    #[new]
    #[pyo3(signature = (vertices, triangles, *, normals = None, velocities = None))]
    fn new(
        vertices: &Bound<'_, PyAny>,
        triangles: &Bound<'_, PyAny>,
        normals: Option<&Bound<'_, PyAny>>,
        velocities: Option<&Bound<'_, PyAny>>,
    ) -> Result<Self> {
        let vertices = arrays::vectors("vertices", vertices)?;
        let triangles = arrays::integers("triangles", triangles, Some(3))?;
        let vectors = |name, value: Option<&Bound<'_, PyAny>>| {
            value.map(|value| arrays::vectors(name, value)).transpose()
        };
        let (normals, velocities) = (vectors("normals", normals)?, vectors("velocities", velocities)?);
        for other in [&normals, &velocities].into_iter().flatten() {
            other.is_apart_from(&vertices)?;
        }
        if let (Some(normals), Some(velocities)) = (&normals, &velocities) {
            velocities.is_apart_from(normals)?;
        }
        let mesh = splashdown::Mesh::new(vertices.values, bytemuck::pod_collect_to_vec(&triangles.values))
            .with_normals(normals.map_or(Vec::new(), |input| input.values))
            .with_velocities(velocities.map_or(Vec::new(), |input| input.values));
        mesh.check().map_err(|error| ArrayError::new_err(error.to_string()))?;
        Ok(Self(Arc::new(mesh)))
    }

    /// Positions of the vertices, (V, 3) float32, m.
    #[getter]
    fn vertices(this: Bound<'_, Self>) -> Result<Bound<'_, PyArray2<f32>>> {
        // SAFETY: the mesh is immutable and owned by `this`; so in the getters below.
        unsafe { vectors_of(this.clone().into_any(), &this.get().0.vertices) }
    }

    /// Three numbers of vertices per triangle, (T, 3) uint32.
    #[getter]
    fn triangles(this: Bound<'_, Self>) -> Result<Bound<'_, PyArray2<u32>>> {
        // SAFETY: see `vertices`.
        unsafe { vectors_of(this.clone().into_any(), &this.get().0.triangles) }
    }

    /// Unit normals of the vertices, (V, 3) float32; (0, 3) if absent.
    #[getter]
    fn normals(this: Bound<'_, Self>) -> Result<Bound<'_, PyArray2<f32>>> {
        // SAFETY: see `vertices`.
        unsafe { vectors_of(this.clone().into_any(), &this.get().0.normals) }
    }

    /// Velocities of the vertices, (V, 3) float32, m/s; (0, 3) if absent.
    #[getter]
    fn velocities(this: Bound<'_, Self>) -> Result<Bound<'_, PyArray2<f32>>> {
        // SAFETY: see `vertices`.
        unsafe { vectors_of(this.clone().into_any(), &this.get().0.velocities) }
    }

    /// Other attributes of the vertices by name: (V,) or (V, 3) float32.
    #[getter]
    fn attributes(this: Bound<'_, Self>) -> Result<Bound<'_, PyDict>> {
        let found = PyDict::new(this.py());
        for attribute in &this.get().0.attributes {
            let owner = this.clone().into_any();
            if attribute.components == 3 {
                // SAFETY: see `vertices`.
                let values =
                    unsafe { vectors_of(owner, bytemuck::cast_slice::<f32, [f32; 3]>(&attribute.values)) }?;
                found.set_item(&attribute.name, values)?;
            } else {
                // SAFETY: see `vertices`.
                let values: Bound<'_, PyArray1<f32>> = unsafe { scalars_of(owner, &attribute.values) }?;
                found.set_item(&attribute.name, values)?;
            }
        }
        Ok(found)
    }

    /// The enclosed volume in m^3, if the mesh is closed.
    #[getter]
    fn volume(&self) -> f64 {
        self.0.volume()
    }

    /// The area of all triangles in m^2.
    #[getter]
    fn area(&self) -> f64 {
        self.0.area()
    }

    /// Whether every edge has exactly two triangles of consistent orientation.
    #[getter]
    fn is_watertight(&self) -> Result<bool> {
        Ok(self.0.topology()?.is_watertight())
    }

    fn __repr__(&self) -> String {
        format!("Mesh({} vertices, {} triangles)", self.0.vertices.len(), self.0.triangles.len())
    }
}
