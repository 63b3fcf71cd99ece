//! Surface reconstruction.

use std::sync::Arc;

use pyo3::prelude::*;
use splashdown::{Device, SurfaceParams};

use crate::argument::{whole, word};
use crate::arrays;
use crate::errors::{ParameterError, Result};
use crate::mesh::Mesh;

/// Reconstructs the surface of any particles as a closed, manifold mesh with normals.
///
/// `points` are the centres of the particles, (N, 3) float32, m. `particle_spacing` is their usual distance in m; twice the
/// particle radius of other programs. `support_radius` (m) is 2 spacings by default, `cell_size` (m) half a spacing, and
/// `iso_level` 0.6. `smoothing` is the number of iterations of weighted Laplacian smoothing; 15 to 25 remove the bumps of
/// the particles. Particles in blobs of fewer than `min_blob` and those with fewer than `min_neighbours` others within 0.9
/// support radii, both at most 32, are left out. `kernels` is "isotropic" or "anisotropic", for smoother films and jets and drops of the right volume.
///
/// >>> points = numpy.random.default_rng(1).random((1000, 3), dtype=numpy.float32)
/// >>> mesh = splashdown.surface(points, 0.1, smoothing=10, device="cpu")
/// >>> mesh.is_watertight, mesh.vertices.shape == mesh.normals.shape
/// (True, True)
/// >>> splashdown.surface(points[:5], 0.1, min_blob=9, device="cpu").vertices.shape
/// (0, 3)
#[pyfunction]
#[pyo3(signature = (points, particle_spacing, *, support_radius = None, cell_size = None, iso_level = None, smoothing = 0, min_blob = 0, min_neighbours = 0, kernels = "isotropic", device = "auto"))]
#[expect(clippy::too_many_arguments, reason = "they are keyword arguments in Python")]
pub fn surface(
    py: Python<'_>,
    points: &Bound<'_, PyAny>,
    particle_spacing: f32,
    support_radius: Option<f32>,
    cell_size: Option<f32>,
    iso_level: Option<f32>,
    smoothing: i64,
    min_blob: i64,
    min_neighbours: i64,
    kernels: &str,
    device: &str,
) -> Result<Mesh> {
    let points = arrays::vectors("points", points)?.values;
    let mut params = SurfaceParams::new(particle_spacing);
    params.support_radius = support_radius.unwrap_or(params.support_radius);
    params.cell_size = cell_size.unwrap_or(params.cell_size);
    params.iso_level = iso_level.unwrap_or(params.iso_level);
    params.smoothing_iterations = whole("smoothing", Some(smoothing), 0)?.unwrap_or(0);
    params.min_blob = whole("min_blob", Some(min_blob), 0)?.unwrap_or(0);
    params.min_neighbours = whole("min_neighbours", Some(min_neighbours), 0)?.unwrap_or(0);
    params.kernels = word("kernels", kernels)?;
    let device = parse_device(device)?;
    let (mesh, _) = py.detach(|| splashdown::reconstruct(&points, &params, &device))?;
    Ok(Mesh(Arc::new(mesh)))
}

/// A device by its name.
///
/// # Errors
/// `ParameterError` for an empty name.
pub fn parse_device(name: &str) -> Result<Device> {
    if name.trim().is_empty() {
        let message =
            "device is empty; it must be \"auto\", \"gpu\", \"cpu\" or part of the name of an adapter";
        return Err(ParameterError::new_err(message).into());
    }
    let Ok(device) = name.parse();
    Ok(device)
}
