use glam::Vec4;
use rayon::prelude::*;
use splashdown_gpu::Scratch;

use super::super::points::Points;
use super::super::{GROUP, GROUPS};
use super::ResidualBindings;
use super::update::{Groups, Update};
use crate::boundary::Images;
use crate::kernel::Kernel;
use crate::pairs::{Differences, NeighbourLists, Outputs, Sorted};
use crate::simd::{Simd, run_with};

pub(super) fn residual<K: Kernel, const BODIES: bool>(scratch: &mut Scratch, buffers: ResidualBindings<'_>) {
    let ResidualBindings {
        params,
        grid,
        state,
        solve,
        cell_start,
        sorted_positions: positions,
        stiffness,
        solid_gradients,
        predicted,
        iterates,
        residuals,
        ..
    } = buffers;
    if solve.stopped != 0 {
        return;
    }
    let scale = 1.0 / params.support_radius;
    let volume = params.summed_mass / params.rest_density;
    let sorted =
        Sorted::new(params.support_radius, grid, cell_start, positions).with_images(Images::new(params));
    let n = sorted.active_count();
    let mut points = std::mem::take(scratch.get::<Points>());
    let all = scratch.get::<NeighbourLists<K>>();
    let lists = if points.predicted_in.take() == Some(solve.iteration) && points.velocities.len() == n {
        all.kept(sorted)
    } else {
        points.set_velocities(&positions[..n], predicted);
        all.of(sorted)
    };
    let factor = volume * (scale * scale) * (scale * scale) * scale;
    lists.for_each(sorted, First(&mut *iterates), &Differences(&points.velocities), |i, sum, images| {
        let u = predicted[i];
        let of_image = |(gradient, sign, j): (Vec4, Vec4, usize)| gradient * (u - sign * predicted[j]);
        let of_images: Vec4 = images.iter().map(of_image).sum();
        let sum = sum + of_images;
        factor * (sum.x + sum.y + sum.z)
    });

    *scratch.get::<Points>() = points;
    let update = &Update::<BODIES> {
        params,
        solve,
        dt: state.dt,
        compressibility: params.compressibility_in(state),
        predicted,
        stiffness,
        solid_gradients,
    };
    let simd = Simd::in_use();
    let tasks = iterates[..n].par_chunks_mut(GROUP * GROUPS).zip(residuals.par_chunks_mut(GROUPS));
    tasks.enumerate().for_each(|(task, (iterates, sums))| {
        run_with(simd, Groups { update, first: task * GROUP * GROUPS, iterates, sums });
    });
}

/// Stores a result as the first component of a vector: the update does not need the old pressure.
struct First<'a>(&'a mut [Vec4]);

impl Outputs<f32> for First<'_> {
    fn split_at(self, middle: usize) -> (Self, Self) {
        let (first, second) = self.0.split_at_mut(middle);
        (Self(first), Self(second))
    }

    #[inline(always)]
    fn put(&mut self, i: usize, value: f32) {
        self.0[i].x = value;
    }
}
