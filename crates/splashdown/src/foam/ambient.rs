//! The fluid at a point, on the CPU; counterpart of `ambient.wgsl`.

use glam::{Vec3, Vec4};
use rayon::prelude::*;

use crate::cells::Grid;
use crate::kernel::{Kernel, WendlandC2};
use crate::pairs::{self, PointSum, Sorted, difference, dot};
use crate::simd::Register;
use crate::state::Params;

/// The fluid, sorted by cell.
pub(super) struct Fluid<'a> {
    pub params: &'a Params,
    pub grid: &'a Grid,
    pub cell_start: &'a [u32],
    pub positions: &'a [Vec4],
    pub velocities: &'a [Vec4],
}

/// The fluid at a point.
#[derive(Clone, Copy)]
pub(super) struct Ambient {
    /// Interpolated velocity of the fluid in m/s.
    pub velocity: Vec3,
    /// Number of neighbours, corrected for the part of the support that walls cut off.
    pub neighbours: f32,
}

impl Fluid<'_> {
    /// The fluid at some points.
    pub fn at(&self, points: &[Vec3]) -> Vec<Ambient> {
        let support_radius = self.params.support_radius;
        let sorted = Sorted::new(support_radius, self.grid, self.cell_start, self.positions);
        let pass =
            Velocity { fluid: self, scale: 1.0 / support_radius, reach: support_radius * support_radius };
        let sums = pairs::sums_at(sorted, points, &pass);
        let ambient = |([u, v, w, weight, neighbours], &x): ([f32; 5], &Vec3)| Ambient {
            velocity: Vec3::new(u, v, w) / weight.max(1e-20),
            neighbours: neighbours / self.fraction_inside(x),
        };
        sums.into_par_iter().zip(points).with_min_len(1024).map(ambient).collect()
    }

    /// The fraction of the support of a point that is inside the closed sides of the domain.
    fn fraction_inside(&self, x: Vec3) -> f32 {
        let scale = 1.0 / self.params.support_radius;
        let mut fraction = 1.0;
        for axis in 0..3 {
            let is_closed = |side: usize| self.params.closed >> (2 * axis + side) & 1 == 1;
            if is_closed(0) {
                fraction *= ball_fraction((x[axis] - self.params.domain_min[axis]) * scale);
            }
            if is_closed(1) {
                fraction *= ball_fraction((self.params.domain_max[axis] - x[axis]) * scale);
            }
        }
        fraction
    }
}

/// Sums of the weighted velocity, of the weights and of the neighbours.
struct Velocity<'a> {
    fluid: &'a Fluid<'a>,
    /// 1 / H
    scale: f32,
    /// H^2
    reach: f32,
}

impl PointSum<6, 5> for Velocity<'_> {
    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 6] {
        let (x, v) = (self.fluid.positions[j], self.fluid.velocities[j]);
        [x.x, x.y, x.z, v.x, v.y, v.z]
    }

    #[inline(always)]
    fn pair<V: Register>(&self, x: [V; 3]) -> impl Fn([V; 6]) -> [V; 5] {
        let (zero, one, reach) = (V::splat(0.0), V::splat(1.0), V::splat(self.reach));
        #[inline(always)]
        move |[x_j, y_j, z_j, u, v, w]| {
            let d = difference(x, [x_j, y_j, z_j]);
            let r2 = dot(d, d);
            let weight = r2.if_less(reach, WendlandC2::w(r2.sqrt() * self.scale), zero);
            [weight * u, weight * v, weight * w, weight, r2.if_less(reach, one, zero)]
        }
    }
}

/// The fraction of the volume of a ball on this side of a plane at `distance` from its centre, in
/// radii.
fn ball_fraction(distance: f32) -> f32 {
    let t = distance.clamp(0.0, 1.0);
    0.5 + t * (0.75 - 0.25 * t * t)
}
