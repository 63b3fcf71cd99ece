//! Surface reconstruction of particles in host memory.

use glam::{Vec3, Vec4};
use splashdown_gpu::Executor;
use splashdown_io::Mesh;

use super::{Surface, SurfaceError, SurfaceInput, SurfaceParams, SurfaceStats};
use crate::cells::{Grid, sort_order};

/// As [`reconstruct`](crate::reconstruct()), on an executor that is already open. Several reconstructions in a row need
/// to open the device only once.
///
/// Positions that are not finite are skipped and counted in [`SurfaceStats::not_finite`]. Without
/// particles the mesh is empty.
///
/// ```
/// use splashdown::surface::{SurfaceParams, reconstruct_with};
/// let mut executor = splashdown::Device::Cpu.executor()?;
/// let drop = [[0.0, 0.0, 0.0], [0.05, 0.0, 0.0], [0.0, 0.05, 0.0]];
/// let (mesh, stats) = reconstruct_with(&drop, &SurfaceParams::new(0.05), &mut executor)?;
/// assert_eq!(mesh.triangles.len(), stats.triangles as usize);
/// # Ok::<(), splashdown::SimulationError>(())
/// ```
///
/// # Errors
/// [`SurfaceError`] if a parameter is invalid, there is no surface at the iso level, there are more
/// than 2^32 - 1 particles, the particles are too far apart for the cell size, or the device is too
/// small.
pub fn reconstruct_with(
    positions: &[[f32; 3]],
    params: &SurfaceParams,
    executor: &mut Executor,
) -> Result<(Mesh, SurfaceStats), SurfaceError> {
    params.check()?;
    check_count(positions.len())?;
    let finite: Vec<Vec3> = positions.iter().map(|&p| Vec3::from(p)).filter(|p| p.is_finite()).collect();
    let not_finite = (positions.len() - finite.len()) as u32;
    if finite.is_empty() {
        return Ok((Mesh::default(), SurfaceStats { not_finite, ..SurfaceStats::default() }));
    }
    let input = upload(executor, &finite, params)?;
    let extracted = extract(executor, params, input);
    executor.free(input.buffers().ids())?;
    let (surface, stats) = extracted?;
    let mesh = surface.into_mesh(executor)?;
    Ok((mesh, SurfaceStats { not_finite, ..stats }))
}

/// Extracts the surface of uploaded points; an empty mesh is an error, after which no buffers remain.
fn extract(
    executor: &mut Executor,
    params: &SurfaceParams,
    input: SurfaceInput,
) -> Result<(Surface, SurfaceStats), SurfaceError> {
    let mut surface = Surface::new(executor, *params, input)?;
    let stats = surface.extract(executor).and_then(|stats| match stats.triangles {
        // All particles can be isolated.
        0 if stats.droplets < input.particle_capacity => {
            let highest = surface.highest(executor, &stats)?;
            Err(SurfaceError::NoSurface { given: params.iso_level, highest })
        }
        _ => Ok(stats),
    });
    match stats {
        Ok(stats) => Ok((surface, stats)),
        Err(error) => {
            surface.free(executor)?;
            Err(error)
        }
    }
}

/// Sorts points by cell and uploads them.
pub(super) fn upload(
    executor: &mut Executor,
    points: &[Vec3],
    params: &SurfaceParams,
) -> Result<SurfaceInput, SurfaceError> {
    let grid = grid_over(points, params)?;
    let (order, cell_start) = sort_order(&grid, points);
    let sorted: Vec<Vec4> = order.iter().map(|&particle| points[particle as usize].extend(0.0)).collect();
    // The index is the id; the particles have no velocities.
    let (ids, moving) = if params.separates() { (&order[..], sorted.len()) } else { (&[][..], 0) };
    Ok(SurfaceInput {
        sorted_positions: executor.create_from("sorted_positions", &sorted)?,
        sorted_velocities: executor.create_from("sorted_velocities", &vec![Vec4::ZERO; moving])?,
        sorted_ids: executor.create_from("sorted_ids", ids)?,
        cell_start: executor.create_from("cell_start", &cell_start)?,
        grid: executor.create_uniform("grid", &grid)?,
        grid_host: grid,
        particle_capacity: sorted.len() as u32,
        solids: None,
    })
}

/// Particles have 32-bit indices.
fn check_count(given: usize) -> Result<(), SurfaceError> {
    match u32::try_from(given) {
        Ok(_) => Ok(()),
        Err(_) => Err(SurfaceError::TooManyParticles { given, allowed: u32::MAX }),
    }
}

/// The largest number of cells of a grid over a number of particles.
fn cell_limit(particles: usize) -> u64 {
    64 * particles as u64 + 4096
}

/// A grid over all particles. If they are far apart, its cells are larger than the support radius,
/// which limits the number of cells.
pub(super) fn grid_over(positions: &[Vec3], params: &SurfaceParams) -> Result<Grid, SurfaceError> {
    let low = positions.iter().fold(Vec3::MAX, |low, &p| low.min(p));
    let high = positions.iter().fold(Vec3::MIN, |high, &p| high.max(p));
    let limit = cell_limit(positions.len());
    let mut cell_size = params.support_radius;
    loop {
        match Grid::new(low, high, cell_size) {
            Some(grid) if u64::from(grid.cell_count) <= limit => return Ok(grid),
            _ if cell_size.is_finite() && (high - low).is_finite() => cell_size *= 1.5,
            _ => {
                let (farthest, cell_size) = (low.abs().max(high.abs()).max_element(), params.cell_size);
                return Err(SurfaceError::TooFar {
                    farthest,
                    cell_size,
                    allowed: super::params::farthest(cell_size),
                });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_of_cells_does_not_overflow_above_67_million_particles() {
        // 64 * 2^26 is 2^32: with 32-bit arithmetic the limit is 4096 cells.
        assert_eq!(cell_limit(1 << 26), (1 << 32) + 4096);
        assert!(cell_limit(u32::MAX as usize) > 1 << 37);
    }

    #[test]
    fn more_particles_than_32_bit_indices_are_refused() {
        assert!(check_count(u32::MAX as usize).is_ok());
        let error = check_count(u32::MAX as usize + 1).unwrap_err().to_string();
        assert!(error.contains("4294967296 particles") && error.contains("4294967295"), "{error}");
    }
}
