//! Interpolation of particle quantities at the vertices of a mesh.

use glam::{Vec3, Vec4};

use super::SurfaceError;
use super::SurfaceParams;
use super::reconstruct::grid_over;
use crate::cells::sort_order;
use crate::pairs::{self, PointSum, Sorted, difference, dot};
use crate::simd::Register;

/// Interpolates scalars or vectors that particles carry, for example velocities, at the vertices of
/// a mesh: the average over the particles within the support radius, weighted by (1 - (r /
/// support)^2)^3 (Shepard 1968), in the unit of the input.
///
/// A vertex without particles within the support radius gets the value of the nearest particle
/// within two support radii, or zero. Smoothing can move vertices that far. Particles whose
/// positions or values are not finite are skipped. `positions` and `values` have one element per
/// particle. Results are bit-identical for any number of threads.
///
/// For 57,000 vertices and 64,000 particles this takes half the time of the extraction of the
/// surface on the CPU (`examples/surface_times.rs`). It runs once per frame, which is why there is
/// no such pass on the device.
///
/// # Errors
/// [`SurfaceError`] if a parameter is invalid or the particles are too far apart.
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
    let mut results = vec![[0.0; N]; vertices.len()];
    if finite.is_empty() {
        return Ok(results);
    }
    let places: Vec<Vec3> = finite.iter().map(|pair| pair.0).collect();
    let grid = grid_over(&places, params)?;
    let (order, cell_start) = sort_order(&grid, &places);
    let (positions, values): (Vec<Vec4>, Vec<[f32; N]>) =
        order.iter().map(|&i| finite[i as usize]).map(|(x, value)| (x.extend(0.0), value)).unzip();
    let sorted = Sorted::new(params.support_radius, &grid, &cell_start, &positions);
    let points: Vec<Vec3> = vertices.iter().map(|&vertex| vertex.into()).collect();
    let inverse2 = 1.0 / (params.support_radius * params.support_radius);
    // Three components at a time: the number of columns of a pass is a constant.
    for first in (0..N).step_by(3) {
        let pass = Average { positions: &positions, values: &values, first, inverse2 };
        let sums = pairs::sums_at(sorted, &points, &pass);
        for ((result, [weights, sums @ ..]), &x) in results.iter_mut().zip(sums).zip(&points) {
            for (component, sum) in (first..N).zip(sums) {
                result[component] = if weights > 0.0 {
                    sum / weights
                } else {
                    nearest(&sorted, x, inverse2).map_or(0.0, |j| values[j][component])
                };
            }
        }
    }
    Ok(results)
}

/// The particle nearest to a point, within two support radii and the cubes around that of the
/// point.
fn nearest(sorted: &Sorted<'_>, x: Vec3, inverse2: f32) -> Option<usize> {
    let distances = sorted.runs_around_point(x).into_iter().flatten().map(|j| {
        let square = sorted.positions[j].truncate().distance_squared(x) * inverse2;
        (square, j)
    });
    let near = distances.filter(|(square, _)| *square < 4.0);
    near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, j)| j)
}

/// Sums of the weights, and of the weighted components from `first` on.
struct Average<'a, const N: usize> {
    positions: &'a [Vec4],
    values: &'a [[f32; N]],
    first: usize,
    /// 1 / H^2
    inverse2: f32,
}

impl<const N: usize> PointSum<6, 4> for Average<'_, N> {
    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 6] {
        let [x, y, z, _] = self.positions[j].to_array();
        let value = |k: usize| self.values[j].get(self.first + k).copied().unwrap_or(0.0);
        [x, y, z, value(0), value(1), value(2)]
    }

    #[inline(always)]
    fn pair<V: Register>(&self, x: [V; 3]) -> impl Fn([V; 6]) -> [V; 4] {
        let (zero, one) = (V::splat(0.0), V::splat(1.0));
        #[inline(always)]
        move |[x_j, y_j, z_j, a, b, c]| {
            let d = difference([x_j, y_j, z_j], x);
            let square = dot(d, d) * self.inverse2;
            let rest = one - square;
            // The comparison is false for NaN.
            let weight = square.if_less(one, rest * rest * rest, zero);
            [weight, weight * a, weight * b, weight * c]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::reconstruct_with;
    use splashdown_gpu::{CpuExecutor, Executor};

    const SPACING: f32 = 0.05;

    fn block() -> Vec<[f32; 3]> {
        (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(|c| SPACING * c as f32)).collect()
    }

    /// The largest difference between the interpolated velocities and a motion.
    fn error(motion: fn(Vec3) -> Vec3, smoothing_iterations: u32) -> f32 {
        let mut executor = Executor::from(CpuExecutor::new());
        let params = SurfaceParams { smoothing_iterations, ..SurfaceParams::new(SPACING) };
        let positions = block();
        let (mesh, _) = reconstruct_with(&positions, &params, &mut executor).unwrap();
        let velocities: Vec<_> = positions.iter().map(|&x| motion(x.into()).to_array()).collect();
        let found = interpolate(&mesh.vertices, &positions, &velocities, &params).unwrap();
        assert_eq!(found.len(), mesh.vertices.len());
        let pairs = mesh.vertices.iter().zip(&found);
        pairs.map(|(&x, &v)| Vec3::from(v).distance(motion(x.into()))).fold(0.0, f32::max)
    }

    #[test]
    fn velocities_are_interpolated() {
        let constant: fn(Vec3) -> Vec3 = |_| Vec3::new(1.0, -2.0, 3.0);
        // A vertex lies at most about one spacing outside the particles around it.
        let turning: fn(Vec3) -> Vec3 = |x| Vec3::Y.cross(x);
        for smoothing in [0, 25] {
            assert!(error(constant, smoothing) < 1e-5);
            let turning = error(turning, smoothing);
            assert!(turning < SPACING && turning > 1e-3 * SPACING, "{turning}");
        }
    }

    #[test]
    fn scalars_are_interpolated() {
        let mut executor = Executor::from(CpuExecutor::new());
        let params = SurfaceParams::new(SPACING);
        let positions = block();
        let (mesh, _) = reconstruct_with(&positions, &params, &mut executor).unwrap();
        let error = |field: fn(f32) -> f32| {
            let values: Vec<_> = positions.iter().map(|x| [field(x[0])]).collect();
            let found = interpolate(&mesh.vertices, &positions, &values, &params).unwrap();
            let pairs = mesh.vertices.iter().zip(&found);
            pairs.map(|(x, [value])| (value - field(x[0])).abs()).fold(0.0, f32::max)
        };
        assert!(error(|_| 293.15) < 1e-3);
        // The error is the distance of a vertex from the particles around, in a field with a slope
        // of 100.
        let slope = error(|x| 100.0 * x);
        assert!((0.01..1.0).contains(&(slope / (100.0 * SPACING))), "{slope}");
    }

    #[test]
    fn distant_and_non_finite_particles_are_handled() {
        let params = SurfaceParams::new(SPACING);
        let near = [[0.0; 3], [f32::NAN, 0.0, 0.0], [0.01, 0.0, 0.0]];
        let velocities = [[1.0, 0.0, 0.0], [9.0; 3], [0.0, f32::INFINITY, 0.0]];
        let vertices = [[0.02, 0.0, 0.0], [0.15, 0.0, 0.0], [50.0, 0.0, 0.0], [f32::NAN; 3]];
        let found = interpolate(&vertices, &near, &velocities, &params).unwrap();
        assert_eq!(found, [[1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0; 3], [0.0; 3]]);
        assert_eq!(interpolate::<3>(&vertices[..1], &[], &[], &params).unwrap(), [[0.0; 3]]);
    }
}
