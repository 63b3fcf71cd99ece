//! What particles carry, at the vertices of their surface.

use glam::Vec3;
use rayon::prelude::*;

use super::SurfaceError;
use super::SurfaceParams;
use super::reconstruct::{grid_over, sort_order};

/// What vertices get of numbers or vectors that particles carry, velocities for example: the mean over the
/// particles within the support radius, weighted by (1 - (r / support)^2)^3 (Shepard 1968), in the unit of what
/// was given.
///
/// A vertex that smoothing has carried away from every particle takes the value of the nearest one that is less
/// than two supports away, or zero. Particles whose positions or values are not finite are left out.
/// `positions` and `values` are those of the particles, one for one; the sum goes over particles in their
/// order, so the same input gives the same bits on any number of threads.
///
/// 57,000 vertices among 64,000 particles take half as long as their surface on the CPU does
/// (`examples/surface_times.rs`), once a frame, which is why there is no such pass on the device.
///
/// # Errors
/// [`SurfaceError`] if a parameter makes no sense or the particles are too far apart.
pub fn interpolate<const N: usize>(
    vertices: &[[f32; 3]],
    positions: &[[f32; 3]],
    values: &[[f32; N]],
    params: &SurfaceParams,
) -> Result<Vec<[f32; N]>, SurfaceError> {
    params.check()?;
    let pairs = positions.iter().zip(values).map(|(&x, &value)| (Vec3::from(x), value));
    let is_finite = |(x, value): &(Vec3, [f32; N])| x.is_finite() && value.iter().all(|v| v.is_finite());
    let finite: Vec<(Vec3, [f32; N])> = pairs.filter(is_finite).collect();
    if finite.is_empty() {
        return Ok(vec![[0.0; N]; vertices.len()]);
    }
    let places: Vec<Vec3> = finite.iter().map(|pair| pair.0).collect();
    let grid = grid_over(&places, params)?;
    let (order, cell_start) = sort_order(&grid, &places);
    let sorted: Vec<(Vec3, [f32; N])> = order.iter().map(|&particle| finite[particle as usize]).collect();
    let (row, layer) = (grid.size_x, grid.size_x * grid.size_y);
    let inverse = 1.0 / (params.support_radius * params.support_radius);
    let mean = |&vertex: &[f32; 3]| {
        let vertex = Vec3::from(vertex);
        let (mut weights, mut sum, mut nearest) = (0.0, [0.0; N], (4.0, [0.0; N]));
        // The cell of a point inside has all 27 around it; three in a row lie side by side.
        let cell = grid.cell_of(vertex);
        for rows in (0..9).map(|n| cell + n % 3 * row + n / 3 * layer - row - layer) {
            let near = cell_start[rows as usize - 1] as usize..cell_start[rows as usize + 2] as usize;
            for (place, value) in &sorted[near] {
                let square = place.distance_squared(vertex) * inverse;
                if square < 1.0 {
                    let weight = (1.0 - square).powi(3);
                    weights += weight;
                    sum.iter_mut().zip(value).for_each(|(sum, value)| *sum += weight * value);
                } else if square < nearest.0 {
                    nearest = (square, *value);
                }
            }
        }
        if weights > 0.0 { sum.map(|sum| sum / weights) } else { nearest.1 }
    };
    Ok(vertices.par_iter().map(mean).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::reconstruct;
    use splashdown_gpu::{CpuExecutor, Executor};

    const SPACING: f32 = 0.05;

    fn block() -> Vec<[f32; 3]> {
        (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(|c| SPACING * c as f32)).collect()
    }

    /// The largest difference between the vertices' velocities and a motion.
    fn error(motion: fn(Vec3) -> Vec3, smoothing_iterations: u32) -> f32 {
        let mut executor = Executor::from(CpuExecutor::new());
        let params = SurfaceParams { smoothing_iterations, ..SurfaceParams::new(SPACING) };
        let positions = block();
        let (mesh, _) = reconstruct(&positions, &params, &mut executor).unwrap();
        let velocities: Vec<_> = positions.iter().map(|&x| motion(x.into()).to_array()).collect();
        let found = interpolate(&mesh.vertices, &positions, &velocities, &params).unwrap();
        assert_eq!(found.len(), mesh.vertices.len());
        let pairs = mesh.vertices.iter().zip(&found);
        pairs.map(|(&x, &v)| Vec3::from(v).distance(motion(x.into()))).fold(0.0, f32::max)
    }

    #[test]
    fn a_motion_comes_to_the_vertices() {
        let constant: fn(Vec3) -> Vec3 = |_| Vec3::new(1.0, -2.0, 3.0);
        // A vertex lies at most about a spacing outside the particles that it hears of.
        let turning: fn(Vec3) -> Vec3 = |x| Vec3::Y.cross(x);
        for smoothing in [0, 25] {
            assert!(error(constant, smoothing) < 1e-5);
            let turning = error(turning, smoothing);
            assert!(turning < SPACING && turning > 1e-3 * SPACING, "{turning}");
        }
    }

    #[test]
    fn a_number_comes_to_the_vertices() {
        let mut executor = Executor::from(CpuExecutor::new());
        let params = SurfaceParams::new(SPACING);
        let positions = block();
        let (mesh, _) = reconstruct(&positions, &params, &mut executor).unwrap();
        let error = |field: fn(f32) -> f32| {
            let values: Vec<_> = positions.iter().map(|x| [field(x[0])]).collect();
            let found = interpolate(&mesh.vertices, &positions, &values, &params).unwrap();
            let pairs = mesh.vertices.iter().zip(&found);
            pairs.map(|(x, [value])| (value - field(x[0])).abs()).fold(0.0, f32::max)
        };
        assert!(error(|_| 293.15) < 1e-3);
        // Off by the way of a vertex to the particles around, in a field with a slope of 100.
        let slope = error(|x| 100.0 * x);
        assert!((0.01..1.0).contains(&(slope / (100.0 * SPACING))), "{slope}");
    }

    #[test]
    fn far_and_broken_particles_do_no_harm() {
        let params = SurfaceParams::new(SPACING);
        let near = [[0.0; 3], [f32::NAN, 0.0, 0.0], [0.01, 0.0, 0.0]];
        let velocities = [[1.0, 0.0, 0.0], [9.0; 3], [0.0, f32::INFINITY, 0.0]];
        let vertices = [[0.02, 0.0, 0.0], [0.15, 0.0, 0.0], [50.0, 0.0, 0.0], [f32::NAN; 3]];
        let found = interpolate(&vertices, &near, &velocities, &params).unwrap();
        assert_eq!(found, [[1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0; 3], [0.0; 3]]);
        assert_eq!(interpolate::<3>(&vertices[..1], &[], &[], &params).unwrap(), [[0.0; 3]]);
    }
}
