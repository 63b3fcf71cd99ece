//! Triangle meshes.

use std::sync::Arc;

use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Inputs, Owner, attributes_of, vectors_of};
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

// SAFETY: the mesh is immutable.
unsafe impl Owner for Mesh {}

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
        let mut inputs = Inputs::default();
        let vertices = inputs.vectors("vertices", Some(vertices))?;
        let triangles = inputs.integers("triangles", Some(triangles), Some(3))?;
        let mesh = splashdown::Mesh::new(vertices, bytemuck::pod_collect_to_vec(&triangles))
            .with_normals(inputs.vectors("normals", normals)?)
            .with_velocities(inputs.vectors("velocities", velocities)?);
        mesh.check().map_err(|error| ArrayError::new_err(error.to_string()))?;
        Ok(Self(Arc::new(mesh)))
    }

    /// Positions of the vertices, (V, 3) float32, m.
    ///
    /// >>> bool((frame.mesh.vertices.max(axis=0) < [0.5, 0.7, 0.6]).all())  # m
    /// True
    #[getter]
    fn vertices<'py>(this: &Bound<'py, Self>) -> Result<Bound<'py, PyArray2<f32>>> {
        vectors_of(this, |mesh| &mesh.0.vertices)
    }

    /// Three numbers of vertices per triangle, (T, 3) uint32.
    ///
    /// >>> bool(frame.mesh.triangles.max() + 1 == len(frame.mesh.vertices))
    /// True
    #[getter]
    fn triangles<'py>(this: &Bound<'py, Self>) -> Result<Bound<'py, PyArray2<u32>>> {
        vectors_of(this, |mesh| &mesh.0.triangles)
    }

    /// Unit normals of the vertices, (V, 3) float32; (0, 3) if absent.
    ///
    /// >>> numpy.allclose(numpy.linalg.norm(frame.mesh.normals, axis=1), 1, atol=1e-4)
    /// True
    #[getter]
    fn normals<'py>(this: &Bound<'py, Self>) -> Result<Bound<'py, PyArray2<f32>>> {
        vectors_of(this, |mesh| &mesh.0.normals)
    }

    /// Velocities of the vertices, (V, 3) float32, m/s; (0, 3) if absent.
    ///
    /// >>> corners, faces = numpy.eye(3, dtype=numpy.float32), numpy.array([[0, 1, 2]])
    /// >>> splashdown.Mesh(corners, faces, velocities=2 * corners).velocities[1].tolist()  # m/s
    /// [0.0, 2.0, 0.0]
    #[getter]
    fn velocities<'py>(this: &Bound<'py, Self>) -> Result<Bound<'py, PyArray2<f32>>> {
        vectors_of(this, |mesh| &mesh.0.velocities)
    }

    /// Other attributes of the vertices by name: (V,) or (V, 3) float32. `read_mesh` does not read any.
    ///
    /// >>> frame.mesh.attributes
    /// {}
    #[getter]
    fn attributes<'py>(this: &Bound<'py, Self>) -> Result<Bound<'py, PyDict>> {
        attributes_of(this, |mesh| &mesh.0.attributes)
    }

    /// The enclosed volume in m^3, if the mesh is closed.
    ///
    /// >>> bool(0.06 < frame.mesh.volume < 0.18)  # m^3; the column has 0.12 m^3
    /// True
    #[getter]
    fn volume(&self) -> f64 {
        self.0.volume()
    }

    /// The area of all triangles in m^2.
    ///
    /// >>> bool(0.8 < frame.mesh.area < 2)  # m^2
    /// True
    #[getter]
    fn area(&self) -> f64 {
        self.0.area()
    }

    /// Whether every edge has exactly two triangles of consistent orientation.
    ///
    /// >>> frame.mesh.is_watertight
    /// True
    #[getter]
    fn is_watertight(&self) -> Result<bool> {
        Ok(self.0.topology()?.is_watertight())
    }

    fn __repr__(&self) -> String {
        format!("Mesh({} vertices, {} triangles)", self.0.vertices.len(), self.0.triangles.len())
    }
}
