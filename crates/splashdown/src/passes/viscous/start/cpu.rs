use std::marker::PhantomData;

use glam::{Vec3, Vec4, Vec4Swizzles};
use rayon::prelude::*;

use super::super::pair::Law;
use super::super::{GROUP, GROUPS};
use super::StartBindings;
use crate::boundary::{Images, Reflection};
use crate::kernel::Kernel;
use crate::pairs::{self, PairSum, Sorted, difference, dot, reflected_point, scaled, splat};
use crate::simd::Register;
use crate::state::Params;

pub(super) fn start<K: Kernel, const BODIES: bool>(buffers: StartBindings<'_>) {
    let StartBindings {
        params,
        grid,
        state,
        viscous,
        cell_start,
        sorted_positions: positions,
        sorted_velocities: velocities,
        accelerations,
        solid_gradients,
        iterates,
        viscous_residuals,
        impulses,
    } = buffers;
    if viscous.stopped != 0 || state.run_count == 0 {
        return;
    }
    let scale = 1.0 / params.support_radius;
    let volume = params.summed_mass / params.rest_density;
    let sorted =
        Sorted::new(params.support_radius, grid, cell_start, positions).with_images(Images::new(params));
    let n = sorted.active_count();
    let pressures: Vec<f32> = iterates[..n].iter().map(|iterate| iterate.x).collect();
    let pass = Start::<K, BODIES> {
        params,
        dt: state.dt,
        positions,
        velocities,
        accelerations,
        solid_gradients,
        pressures: &pressures,
        scale,
        factor: volume * (scale * scale) * (scale * scale) * scale,
        kernel: PhantomData,
    };
    pairs::for_each(sorted, (viscous_residuals, iterates), &pass);
    let change = |a: &Vec4| if a.w == 1.0 { 0.0 } else { state.dt * state.dt * a.xyz().length_squared() };
    let tasks = accelerations[..n].par_chunks(GROUP * GROUPS).zip(impulses.par_chunks_mut(GROUPS));
    tasks.for_each(|(accelerations, sums)| {
        for (group, sum) in accelerations.chunks(GROUP).zip(sums) {
            *sum = Vec4::new(group.iter().map(change).sum(), 0.0, 0.0, 0.0);
        }
    });
}

struct Start<'a, K, const BODIES: bool> {
    params: &'a Params,
    dt: f32,
    positions: &'a [Vec4],
    velocities: &'a [Vec4],
    accelerations: &'a [Vec4],
    solid_gradients: &'a [Vec4],
    /// The pressure solver's unknown at the start.
    pressures: &'a [f32],
    scale: f32,
    /// Of the gradient.
    factor: f32,
    kernel: PhantomData<K>,
}

impl<K, const BODIES: bool> Start<'_, K, BODIES> {
    /// True where a nozzle determines the motion.
    #[inline(always)]
    fn is_driven(&self, i: usize) -> bool {
        self.accelerations[i].w == 1.0
    }
}

/// The columns: position, velocity, signs of the reflection, pressure. The sums: viscous force, trace of the diagonal,
/// force of the pressure.
impl<K: Kernel, const BODIES: bool> PairSum<10, 7> for Start<'_, K, BODIES> {
    type Output = (Vec4, Vec4);

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 10] {
        let (p, v) = (self.positions[j], self.velocities[j]);
        [p.x, p.y, p.z, v.x, v.y, v.z, 1.0, 1.0, 1.0, self.pressures[j]]
    }

    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 10]) -> [V; 7] {
        let (x, v) = (splat::<V>(self.positions[i]), splat::<V>(self.velocities[i]));
        let k = V::splat(self.pressures[i]);
        let law = Law::<V>::new(self.params.support_radius, self.params.wall_friction);
        #[inline(always)]
        move |[x_j, y_j, z_j, u_j, v_j, w_j, a, b, c, k_j]| {
            let d = difference(x, [x_j, y_j, z_j]);
            let r2 = dot(d, d);
            let f = law.with_friction(v, [u_j, v_j, w_j], d, [a, b, c]);
            let p = scaled(K::g(r2.sqrt() * self.scale) * (k + k_j), d);
            [f[0], f[1], f[2], law.weight(r2) * r2, p[0], p[1], p[2]]
        }
    }

    #[inline(always)]
    fn reflect<V: Register>(&self, by: &Reflection, values: [V; 10]) -> [V; 10] {
        let [x, y, z, u, v, w, a, b, c, k] = values;
        let [x, y, z] = reflected_point(by, [x, y, z]);
        let [e, f, g] = by.sign.to_array().map(V::splat);
        [x, y, z, u, v, w, a * e, b * f, c * g, k]
    }

    #[inline(always)]
    fn finish(&self, i: usize, sums: [f32; 7]) -> Self::Output {
        let own = self.pressures[i];
        if self.is_driven(i) {
            return (Vec4::ZERO, Vec4::new(own, 0.0, 0.0, 0.0));
        }
        let Self { params, dt, .. } = *self;
        let [fx, fy, fz, trace, px, py, pz] = sums;
        let mut pressure = -self.factor * Vec3::new(px, py, pz);
        if BODIES {
            pressure -= own * self.solid_gradients[i].xyz();
        }
        let viscous = params.viscous_factor * Vec3::new(fx, fy, fz);
        let residual = dt * (self.accelerations[i].xyz() + pressure - viscous);
        let diagonal = 1.0 + dt * params.viscous_factor * trace / 3.0;
        (residual.extend(1.0 / diagonal), Vec4::new(own, pressure.x, pressure.y, pressure.z))
    }

    #[inline(always)]
    fn wants(&self, i: usize) -> bool {
        !self.is_driven(i)
    }
}
