//! Surface reconstruction for any particle data in one call, which opens the device.

use splashdown_io::Mesh;

use crate::surface::{self, SurfaceParams, SurfaceStats};
use crate::{Device, SimulationError};

/// Reconstructs the surface of particles as a closed, manifold triangle mesh. `points` are the centres of the particles
/// in m; points that are not finite are skipped and counted in [`SurfaceStats::not_finite`].
///
/// ```
/// use splashdown::{Device, SurfaceParams, reconstruct};
/// let points = [[0.0, 0.0, 0.0], [0.05, 0.0, 0.0], [0.0, 0.05, 0.0]];
/// let (mesh, _) = reconstruct(&points, &SurfaceParams::new(0.05), &Device::Cpu)?;
/// assert!(mesh.triangles.len() > 100);
/// # Ok::<(), splashdown::SimulationError>(())
/// ```
///
/// # Errors
/// [`SimulationError::Surface`] if a parameter is invalid, no surface has the iso level, or the points are too far
/// apart for the cell size; [`SimulationError::Gpu`] if the device is missing or too small.
pub fn reconstruct(
    points: &[[f32; 3]],
    params: &SurfaceParams,
    device: &Device,
) -> Result<(Mesh, SurfaceStats), SimulationError> {
    Ok(surface::reconstruct_with(points, params, &mut device.executor()?)?)
}
