use std::marker::PhantomData;

use glam::{Vec3, Vec4, Vec4Swizzles};
use rayon::prelude::*;

use super::super::{GROUP, GROUPS};
use super::PredictBindings;
use crate::boundary::{Images, Reflection};
use crate::kernel::Kernel;
use crate::pairs::{self, PairSum, Sorted, difference, dot, reflected_point, scaled, splat};
use crate::simd::Register;

pub(super) fn predict<K: Kernel, const BODIES: bool>(buffers: PredictBindings<'_>) {
    let PredictBindings {
        params,
        grid,
        state,
        solve,
        cell_start,
        sorted_positions: positions,
        sorted_velocities: velocities,
        accelerations,
        solid_gradients,
        iterates,
        predicted,
        impulses,
    } = buffers;
    if solve.stopped != 0 {
        return;
    }
    let scale = 1.0 / params.support_radius;
    let volume = params.summed_mass / params.rest_density;
    let pass = Predict::<K, BODIES> {
        dt: state.dt,
        beta: solve.beta,
        positions,
        velocities,
        accelerations,
        solid_gradients,
        iterates,
        scale,
        factor: volume * (scale * scale) * (scale * scale) * scale,
        kernel: PhantomData,
    };
    let sorted =
        Sorted::new(params.support_radius, grid, cell_start, positions).with_images(Images::new(params));
    pairs::for_each(sorted, &mut *predicted, &pass);
    let predicted = &predicted[..sorted.active_count()];
    let tasks = predicted.par_chunks(GROUP * GROUPS).zip(impulses.par_chunks_mut(GROUPS));
    tasks.enumerate().for_each(|(task, (predicted, sums))| {
        for (group, (predicted, sum)) in predicted.chunks(GROUP).zip(sums).enumerate() {
            let first = (task * GROUPS + group) * GROUP;
            *sum = Vec4::ZERO;
            for (i, predicted) in predicted.iter().enumerate() {
                let (u, k) = (predicted.xyz(), predicted.w.max(0.0));
                sum.x += (pass.without_pressure(first + i) - u).length_squared();
                sum.y = sum.y.max(k);
                sum.z += k * k;
                sum.w += u.length_squared();
            }
        }
    });
}

struct Predict<'a, K, const BODIES: bool> {
    dt: f32,
    beta: f32,
    positions: &'a [Vec4],
    velocities: &'a [Vec4],
    accelerations: &'a [Vec4],
    solid_gradients: &'a [Vec4],
    iterates: &'a [Vec4],
    scale: f32,
    factor: f32,
    kernel: PhantomData<K>,
}

impl<K, const BODIES: bool> Predict<'_, K, BODIES> {
    #[inline(always)]
    fn pressure(&self, j: usize) -> f32 {
        (self.iterates[j].x + self.beta * self.iterates[j].y).max(0.0)
    }

    /// The velocity by all other forces.
    #[inline(always)]
    fn without_pressure(&self, i: usize) -> Vec3 {
        self.velocities[i].xyz() + self.dt * self.accelerations[i].xyz()
    }

    /// True where a nozzle determines the motion.
    #[inline(always)]
    fn is_driven(&self, i: usize) -> bool {
        self.accelerations[i].w == 1.0
    }
}

impl<K: Kernel, const BODIES: bool> PairSum<4, 3> for Predict<'_, K, BODIES> {
    type Output = Vec4;

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 4] {
        let p = self.positions[j];
        [p.x, p.y, p.z, self.pressure(j)]
    }

    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 4]) -> [V; 3] {
        let (x, k) = (splat::<V>(self.positions[i]), V::splat(self.pressure(i)));
        #[inline(always)]
        move |[x_j, y_j, z_j, k_j]| {
            let d = difference(x, [x_j, y_j, z_j]);
            scaled(K::g(dot(d, d).sqrt() * self.scale) * (k + k_j), d)
        }
    }

    #[inline(always)]
    fn reflect<V: Register>(&self, by: &Reflection, [x, y, z, k]: [V; 4]) -> [V; 4] {
        let [x, y, z] = reflected_point(by, [x, y, z]);
        [x, y, z, k]
    }

    #[inline(always)]
    fn finish(&self, i: usize, sums: [f32; 3]) -> Vec4 {
        let v = self.without_pressure(i);
        if self.is_driven(i) {
            return v.extend(-1.0);
        }
        let k = self.pressure(i);
        let mut q = self.factor * Vec3::from(sums);
        if BODIES {
            q += k * self.solid_gradients[i].xyz();
        }
        (v - self.dt * q).extend(k)
    }

    #[inline(always)]
    fn wants(&self, i: usize) -> bool {
        !self.is_driven(i)
    }
}
