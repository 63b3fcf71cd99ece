use std::marker::PhantomData;

use glam::{Vec4, Vec4Swizzles};
use rayon::prelude::*;

use super::super::{GROUP, GROUPS};
use super::ResidualBindings;
use crate::boundary::{Images, Reflection};
use crate::kernel::Kernel;
use crate::pairs::{self, Outputs, PairSum, Sorted, difference, dot, reflected, reflected_point, splat};
use crate::simd::Register;

pub(super) fn residual<K: Kernel, const BODIES: bool>(buffers: ResidualBindings<'_>) {
    let ResidualBindings {
        params,
        grid,
        state,
        solve,
        cell_start,
        sorted_positions: positions,
        densities,
        stiffness,
        solid_gradients,
        predicted,
        iterates,
        residuals,
    } = buffers;
    if solve.stopped != 0 {
        return;
    }
    let scale = 1.0 / params.support_radius;
    let volume = params.summed_mass / params.rest_density;
    let pass = Rate::<K> {
        positions,
        predicted,
        scale,
        factor: volume * (scale * scale) * (scale * scale) * scale,
        kernel: PhantomData,
    };
    let sorted =
        Sorted::new(params.support_radius, grid, cell_start, positions).with_images(Images::new(params));
    let n = sorted.active_count();
    pairs::for_each(sorted, Last(&mut *iterates), &pass);

    let update = |i: usize, iterate: &mut Vec4| {
        let excess = densities[i].x / params.rest_density - 1.0;
        let (u, k) = (predicted[i].xyz(), predicted[i].w);
        if k < 0.0 {
            *iterate = Vec4::ZERO;
            return Vec4::new(0.0, 0.0, excess.max(0.0), 0.0);
        }
        let (mut rate, mut gradient) = (iterate.w, stiffness[i].xyz());
        if BODIES {
            let solid = solid_gradients[i];
            rate += solid.xyz().dot(u) - solid.w;
            gradient += solid.xyz();
        }
        let residual = excess + state.dt * rate;
        let diagonal = (gradient.length_squared() + stiffness[i].w).max(1e-6 * scale * scale);
        let diagonal = state.dt * state.dt * diagonal;
        let next = (k + solve.relaxation * residual / diagonal).max(0.0);
        let change = next - k;
        let direction = solve.beta * iterate.y + iterate.z;
        *iterate = Vec4::new(next, direction, change, residual);
        let error = if k > 0.0 { residual.abs() } else { residual.max(0.0) };
        Vec4::new(error, diagonal * change * change, excess.max(0.0), k * residual)
    };
    let tasks = iterates[..n].par_chunks_mut(GROUP * GROUPS).zip(residuals.par_chunks_mut(GROUPS));
    tasks.enumerate().for_each(|(task, (iterates, sums))| {
        for (group, (iterates, sum)) in iterates.chunks_mut(GROUP).zip(sums).enumerate() {
            let first = (task * GROUPS + group) * GROUP;
            *sum = Vec4::ZERO;
            for (k, iterate) in iterates.iter_mut().enumerate() {
                *sum += update(first + k, iterate);
            }
        }
    });
}

/// Stores a result as the fourth component of a vector.
struct Last<'a>(&'a mut [Vec4]);

impl Outputs<f32> for Last<'_> {
    fn split_at(self, middle: usize) -> (Self, Self) {
        let (first, second) = self.0.split_at_mut(middle);
        (Self(first), Self(second))
    }

    #[inline(always)]
    fn put(&mut self, i: usize, value: f32) {
        self.0[i].w = value;
    }
}

/// The sum over the neighbours in the rate of the density.
struct Rate<'a, K> {
    positions: &'a [Vec4],
    predicted: &'a [Vec4],
    scale: f32,
    factor: f32,
    kernel: PhantomData<K>,
}

impl<K: Kernel> PairSum<6, 1> for Rate<'_, K> {
    type Output = f32;

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 6] {
        let (p, u) = (self.positions[j], self.predicted[j]);
        [p.x, p.y, p.z, u.x, u.y, u.z]
    }

    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 6]) -> [V; 1] {
        let (x, u) = (splat::<V>(self.positions[i]), splat::<V>(self.predicted[i]));
        #[inline(always)]
        move |[x_j, y_j, z_j, u_j, v_j, w_j]| {
            let d = difference(x, [x_j, y_j, z_j]);
            [K::g(dot(d, d).sqrt() * self.scale) * dot(d, difference(u, [u_j, v_j, w_j]))]
        }
    }

    #[inline(always)]
    fn reflect<V: Register>(&self, by: &Reflection, values: [V; 6]) -> [V; 6] {
        let [x, y, z, u, v, w] = values;
        let [x, y, z] = reflected_point(by, [x, y, z]);
        let [u, v, w] = reflected(by, [u, v, w]);
        [x, y, z, u, v, w]
    }

    #[inline(always)]
    fn finish(&self, _: usize, [sum]: [f32; 1]) -> f32 {
        self.factor * sum
    }
}
