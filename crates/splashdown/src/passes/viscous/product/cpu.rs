use glam::{Vec3, Vec4, Vec4Swizzles};
use rayon::prelude::*;
use splashdown_gpu::Scratch;

use super::super::pair::{Law, Root};
use super::super::{GROUP, GROUPS};
use super::ProductBindings;
use crate::boundary::Images;
use crate::pairs::{Differences, NearImages, NeighbourLists, Outputs, Projections, Sorted};

/// Particles per task.
const CHUNK: usize = 4096;

/// The position and the preconditioned residual of every particle, whose fourth component is zero. Kept from iteration to
/// iteration, because new memory is slow.
#[derive(Default)]
struct Points(Vec<[Vec4; 2]>);

pub(super) fn product<const BODIES: bool>(scratch: &mut Scratch, buffers: ProductBindings<'_>) {
    let ProductBindings {
        params,
        grid,
        state,
        viscous,
        cell_start,
        sorted_positions: positions,
        viscous_residuals,
        viscous_products,
        residuals,
        ..
    } = buffers;
    if viscous.stopped != 0 {
        return;
    }
    let sorted =
        Sorted::new(params.support_radius, grid, cell_start, positions).with_images(Images::new(params));
    let n = sorted.active_count();
    let mut points = std::mem::take(&mut scratch.get::<Points>().0);
    points.resize(n, [Vec4::ZERO; 2]);
    let each = points.par_iter_mut().zip(&positions[..n]).zip(viscous_residuals);
    each.with_min_len(CHUNK).for_each(|((point, x), r)| *point = [*x, (r.w * *r).with_w(0.0)]);
    let all = scratch.get::<NeighbourLists<Root>>();
    // The particles keep their places for all iterations of a step.
    let lists = if viscous.iteration == 0 { all.of(sorted) } else { all.kept(sorted) };
    let pass = Product {
        rate: state.dt * params.viscous_factor / (params.support_radius * params.support_radius),
        residuals: viscous_residuals,
        points: &points,
        friction: params.wall_friction,
        law: Law::new(params.support_radius, params.wall_friction),
    };
    let formula = Projections(Differences(pass.points));
    lists.for_each(sorted, Stored::<BODIES>(viscous_products), &formula, |i, sum, images| {
        pass.result(i, sum, images)
    });
    scratch.get::<Points>().0 = points;
    let products = &viscous_products[..n];
    let tasks = products.par_chunks(GROUP * GROUPS).zip(residuals.par_chunks_mut(GROUPS));
    tasks.enumerate().for_each(|(task, (products, sums))| {
        for (group, (products, sum)) in products.chunks(GROUP).zip(sums).enumerate() {
            let first = (task * GROUPS + group) * GROUP;
            let terms = |(k, w): (usize, &Vec4)| {
                let r = viscous_residuals[first + k];
                if r.w == 0.0 {
                    return Vec4::ZERO;
                }
                let (r, z) = (r.xyz(), r.w * r.xyz());
                Vec4::new(r.dot(z), z.dot(w.xyz()), r.length_squared(), z.length_squared())
            };
            *sum = products.iter().enumerate().map(terms).sum();
        }
    });
}

/// Stores the results, or adds them to what is there.
struct Stored<'a, const ADDS: bool>(&'a mut [Vec4]);

impl<const ADDS: bool> Outputs<Vec4> for Stored<'_, ADDS> {
    fn split_at(self, middle: usize) -> (Self, Self) {
        let (first, second) = self.0.split_at_mut(middle);
        (Self(first), Self(second))
    }

    #[inline(always)]
    fn put(&mut self, i: usize, value: Vec4) {
        self.0[i] = if ADDS { self.0[i] + value } else { value };
    }
}

struct Product<'a> {
    /// Factor of the sums.
    rate: f32,
    residuals: &'a [Vec4],
    /// See [`Points`].
    points: &'a [[Vec4; 2]],
    friction: f32,
    law: Law<f32>,
}

impl Product<'_> {
    #[inline(always)]
    fn result(&self, i: usize, of_particles: Vec4, images: NearImages<'_>) -> Vec4 {
        // Where a nozzle determines the motion.
        if self.residuals[i].w == 0.0 {
            return Vec4::ZERO;
        }
        let [_, own] = self.points[i];
        let of_images: Vec4 = images
            .iter()
            .map(|(s, sign, j)| self.of_image(s.xyz(), sign.xyz(), own.xyz(), self.points[j][1].xyz()))
            .sum();
        (own + self.rate * (of_particles + of_images)).xyz().extend(0.0)
    }

    /// The force of an image, for its vector `s` in the list and the vectors of the particle and of that which is reflected.
    #[inline(always)]
    fn of_image(&self, s: Vec3, sign: Vec3, own: Vec3, other: Vec3) -> Vec4 {
        if self.friction == 0.0 {
            return (s * s.dot(own - sign * other)).extend(0.0);
        }
        let [v, u, s, sign] = [own, other, s, sign].map(|v| v.to_array());
        Vec3::from(self.law.unweighted(v, u, s, sign)).extend(0.0)
    }
}
