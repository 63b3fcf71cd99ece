//! The density of the fluid from the positions of its particles, whatever the solver believes.
//!
//! A sum over the neighbours with the Wendland kernel and their images behind closed sides. For deficits, the part of the
//! kernel inside the nearest body is added as if its surface were plane; for excess it is not, so that the reported excess
//! next to bodies is a lower bound. One particle in [`ONE_OF`] is evaluated per frame, others in each frame, and at least
//! 2,048.

use glam::{Vec3, Vec4};
use rayon::prelude::*;

use crate::boundary::{KernelPair, SolidDistance};
use crate::cells::{Grid, sort_order};
use crate::kernel::{Kernel, WendlandC2};
use crate::pairs::{PointSum, Sorted, difference, dot, scaled, sums_at};
use crate::scene::{KernelKind, Method, lattice_sum};
use crate::simd::Register;
use crate::state::Params;

/// Of how many particles one is evaluated, and the bounds of their number: they limit the cost of a frame.
const ONE_OF: usize = 8;
const EVALUATED: [usize; 2] = [2048, 16_384];
/// The support of the sum in spacings: that of the solver, at least this.
const SUPPORT: f32 = 2.4;
/// Particles whose kernel has a larger gradient of the filled fraction, times the support, are at a free surface.
const OPEN: f32 = 0.3;
/// Particles below this relative density are spray.
const SPRAY: f32 = 0.6;
/// The part of the particles that may exceed the reported values.
const FRACTION: f64 = 0.01;

/// The relative deviation of the density from the rest density, from the positions of the particles, walls and bodies
/// included.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct DensityError {
    /// The excess that one particle in a hundred has.
    pub excess: f32,
    /// The deficit that one particle in a hundred of those that are neither at a free surface nor spray has.
    pub deficit: f32,
    /// The largest excess.
    pub largest: f32,
    /// Where it is, in m.
    pub largest_place: [f32; 3],
    /// Where the largest deficit is, in m.
    pub deficit_place: [f32; 3],
}

/// The deviations of these particles. `turn` selects which of many particles are evaluated. `distance` gives the distance in m of a point from the nearest body, if any.
pub(super) fn density_error(
    params: &Params,
    positions: &[[f32; 3]],
    turn: u64,
    distance: &(dyn Fn(Vec3) -> Option<f32> + Sync),
) -> DensityError {
    let spacing = params.particle_spacing;
    let support = params.support_radius.max(SUPPORT * spacing);
    let ratio = support / spacing;
    let lattice = lattice_sum(Method::Wcsph, KernelKind::WendlandC2, ratio.into()) as f32;
    let weight = (spacing / support).powi(3) / lattice;
    let offset = spacing * SolidDistance::of_density(KernelPair::WendlandC2, ratio).offset;
    let most = (positions.len() / ONE_OF).clamp(EVALUATED[0], EVALUATED[1]);
    let stride = positions.len().div_ceil(most).max(1);
    let first = (turn % stride as u64) as usize;
    let chosen: Vec<usize> = (first..positions.len()).step_by(stride).collect();
    let with_images = |&i: &usize| {
        let images = images(params, positions[i].into(), support).into_iter();
        images.map(move |(position, sign)| Place { particle: i, position, sign })
    };
    let counts = |i: &&usize| is_near(params, positions[**i].into(), support);
    let points: Vec<Place> = chosen.par_iter().filter(counts).flat_map_iter(with_images).collect();
    let places: Vec<Vec3> = points.iter().map(|point| point.position).collect();
    let sums = kernel_sums(params, positions, &places, support);
    let mut rest = &sums[..];
    let of_particles = points.chunk_by(|a, b| a.particle == b.particle).map(|points| {
        let (sums, after) = rest.split_at(points.len());
        rest = after;
        (points, sums)
    });
    let of_particles: Vec<_> = of_particles.collect();
    let evaluate = |&(points, sums): &(&[Place], &[[f32; 4]])| {
        let Place { particle: i, position: x, .. } = points[0];
        let (mut density, mut slope) = (0.0, Vec3::ZERO);
        for (Place { sign, .. }, &[w, gx, gy, gz]) in points.iter().zip(sums) {
            density += weight * w;
            slope += weight * *sign * Vec3::new(gx, gy, gz);
        }
        // Without the body: a half-space is more than a thin or convex body, and must not look like compressed fluid.
        let fluid = density;
        let mut open = slope.length();
        if let Some(distance) = distance(x).filter(|distance| *distance < support) {
            let fraction = |d: f32| {
                let q = (d / support).clamp(-1.0, 1.0);
                let solid = KernelPair::WendlandC2.density(q.abs()).0;
                if q < 0.0 { 1.0 - solid } else { solid }
            };
            density += fraction(distance + offset);
            // Inside the fluid the body's part of the kernel cancels the slope of the fluid's part.
            let q = (distance / support).clamp(0.0, 1.0);
            open = (open - KernelPair::WendlandC2.density(q).1).abs();
        }
        (i, fluid, density, open)
    };
    let evaluated: Vec<(usize, f32, f32, f32)> = of_particles.par_iter().map(evaluate).collect();
    let mut all: Vec<(usize, f32)> =
        evaluated.iter().filter(|one| one.1.is_finite()).map(|&(i, fluid, ..)| (i, fluid)).collect();
    let is_inner = |one: &&(usize, f32, f32, f32)| one.2 > SPRAY && one.3 < OPEN;
    let mut inner: Vec<(usize, f32)> =
        evaluated.iter().filter(is_inner).map(|&(i, _, density, _)| (i, density)).collect();
    // The order of equal densities is that of the particles, so that the result repeats.
    all.sort_by(|a, b| b.1.total_cmp(&a.1));
    inner.sort_by(|a, b| a.1.total_cmp(&b.1));
    let quantile =
        |sorted: &[(usize, f32)]| sorted.get((FRACTION * sorted.len() as f64) as usize).map(|one| one.1);
    let place = |sorted: &[(usize, f32)]| sorted.first().map_or([f32::NAN; 3], |one| positions[one.0]);
    DensityError {
        excess: quantile(&all).map_or(0.0, |density| (density - 1.0).max(0.0)),
        deficit: quantile(&inner).map_or(0.0, |density| (1.0 - density).max(0.0)),
        largest: all.first().map_or(0.0, |one| (one.1 - 1.0).max(0.0)),
        largest_place: place(&all),
        deficit_place: place(&inner),
    }
}

/// True for points in the domain or within the support of it. Squares of distances between such points are finite.
fn is_near(params: &Params, x: Vec3, support: f32) -> bool {
    x.cmpge(params.domain_min - support).all() && x.cmple(params.domain_max + support).all()
}

/// A particle or one of its images.
struct Place {
    /// The index of the particle.
    particle: usize,
    position: Vec3,
    /// The signs of the reflection.
    sign: Vec3,
}

/// A point and its images behind the closed sides within the support, each with the signs of the reflection.
fn images(params: &Params, x: Vec3, support: f32) -> Vec<(Vec3, Vec3)> {
    let mut found = vec![(x, Vec3::ONE)];
    for axis in 0..3 {
        for (side, plane) in [params.domain_min[axis], params.domain_max[axis]].into_iter().enumerate() {
            let is_closed = params.closed >> (2 * axis + side) & 1 == 1;
            if is_closed && (x[axis] - plane).abs() < support {
                let own = found.iter().filter(|(image, sign)| sign[axis] > 0.0 && image[axis] == x[axis]);
                let mut reflected: Vec<(Vec3, Vec3)> = own.copied().collect();
                for (image, sign) in &mut reflected {
                    image[axis] = 2.0 * plane - image[axis];
                    sign[axis] = -1.0;
                }
                found.extend(reflected);
            }
        }
    }
    found
}

/// At each point the sum of W H^3 over the particles, and its gradient times H^4.
fn kernel_sums(params: &Params, positions: &[[f32; 3]], points: &[Vec3], support: f32) -> Vec<[f32; 4]> {
    let all = positions.iter().map(|&x| Vec3::from(x));
    let near: Vec<Vec3> = all.filter(|&x| is_near(params, x, support)).collect();
    // A box around the particles, because that of the domain may be much larger. What is beyond it, images and particles
    // outside the domain, is in the outermost cells.
    let inside = |x: &Vec3| x.clamp(params.domain_min, params.domain_max);
    let low = near.iter().map(inside).fold(params.domain_max, Vec3::min);
    let high = near.iter().map(inside).fold(low, Vec3::max);
    let grid = Grid::new(low, high, support).expect("a checked scene has few enough particles and cells");
    let (order, cell_start) = sort_order(&grid, &near);
    let sorted: Vec<Vec4> = order.iter().map(|&i| near[i as usize].extend(0.0)).collect();
    let pass = KernelSum { positions: &sorted, scale: 1.0 / support };
    sums_at(Sorted::new(support, &grid, &cell_start, &sorted), points, &pass)
}

/// The sum of the kernel, and of its gradient.
struct KernelSum<'a> {
    positions: &'a [Vec4],
    /// 1 / H
    scale: f32,
}

impl PointSum<3, 4> for KernelSum<'_> {
    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 3] {
        self.positions[j].truncate().to_array()
    }

    #[inline(always)]
    fn pair<V: Register>(&self, x: [V; 3]) -> impl Fn([V; 3]) -> [V; 4] {
        let scale = V::splat(self.scale);
        #[inline(always)]
        move |x_j| {
            // Scaled after the square, which is finite for the padding of the candidates.
            let d = difference(x, x_j);
            let q = dot(d, d).sqrt() * scale;
            let [gx, gy, gz] = scaled(WendlandC2::g(q) * scale, d);
            [WendlandC2::w(q), gx, gy, gz]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box filled with a lattice, with closed sides except the lid, in units of the spacing.
    fn error(squeeze: f32) -> DensityError {
        let params = Params {
            domain_min: Vec3::ZERO,
            domain_max: Vec3::new(8.0, 20.0, 8.0),
            particle_spacing: 1.0,
            support_radius: 2.0,
            closed: 0b110111,
            ..bytemuck::Zeroable::zeroed()
        };
        let at = |k: usize| [k % 8, k / 64, k / 8 % 8].map(|n| n as f32 + 0.5);
        let positions: Vec<[f32; 3]> = (0..512).map(at).map(|[x, y, z]| [x, squeeze * y, z]).collect();
        density_error(&params, &positions, 0, &|_| None)
    }

    #[test]
    fn a_lattice_between_walls_has_the_rest_density_everywhere() {
        let error = error(1.0);
        assert!(error.excess < 1e-3 && error.deficit < 1e-3, "{error:?}");
    }

    #[test]
    fn particles_outside_and_a_large_domain_do_not_matter() {
        let at = |k: usize| [k % 8, k / 64, k / 8 % 8].map(|n| n as f32 + 0.5);
        let mut positions: Vec<[f32; 3]> = (0..512).map(at).collect();
        let params = |size: f32| Params {
            domain_min: Vec3::ZERO,
            domain_max: Vec3::splat(size),
            particle_spacing: 1.0,
            support_radius: 2.0,
            closed: 0b010101,
            ..bytemuck::Zeroable::zeroed()
        };
        let error = |positions: &[[f32; 3]], size| density_error(&params(size), positions, 0, &|_| None);
        let alone = error(&positions, 20.0);
        assert!(alone.largest < 1e-3, "{alone:?}");
        // A grid of this domain would need 5e14 cells.
        assert_eq!(error(&positions, 1e5), alone);
        positions.extend([[f32::NAN; 3], [-1e30; 3], [3.0, 1e30, 3.0]]);
        assert_eq!(error(&positions, 20.0).largest, alone.largest);
        positions.push([2.6; 3]);
        assert!(error(&positions, 20.0).largest > 0.1, "control: one more particle inside");
        assert_eq!(error(&[], 20.0).largest, 0.0);
    }

    #[test]
    fn small_spacings_have_the_same_result() {
        let scaled = |scale: f32| {
            let params = Params {
                domain_max: Vec3::splat(8.0 * scale),
                particle_spacing: scale,
                support_radius: 2.0 * scale,
                closed: 0b111111,
                ..bytemuck::Zeroable::zeroed()
            };
            let at = |k: usize| [k % 8, k / 64, k / 8 % 8].map(|n| (n as f32 + 0.5) * scale);
            let mut positions: Vec<[f32; 3]> = (0..512).map(at).collect();
            positions.push([2.6 * scale; 3]);
            density_error(&params, &positions, 0, &|_| None).largest
        };
        assert!(scaled(1.0) > 0.1);
        assert!((scaled(1e-5) / scaled(1.0) - 1.0).abs() < 1e-3, "{} {}", scaled(1e-5), scaled(1.0));
    }

    #[test]
    fn compressed_and_stretched_fluid_is_found() {
        let dense = error(0.8);
        assert!((dense.excess - 0.25).abs() < 0.02 && dense.deficit < 0.01, "{dense:?}");
        let thin = error(1.2);
        assert!((thin.deficit - 1.0 / 6.0).abs() < 0.02 && thin.excess < 0.01, "{thin:?}");
    }
}
