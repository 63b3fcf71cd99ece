use std::marker::PhantomData;

use glam::{Vec2, Vec4, Vec4Swizzles};

use super::DensityBindings;
use crate::boundary::Images;
use crate::kernel::Kernel;
use crate::pairs::{self, PairSum, Sorted, difference, dot, splat};
use crate::simd::Register;
use crate::state::Params;

pub(super) fn density<K: Kernel>(buffers: DensityBindings<'_>) {
    let DensityBindings { params, grid, cell_start, sorted_positions: positions, densities } = buffers;
    let scale = 1.0 / params.support_radius;
    let pass = Density::<K> {
        params,
        positions,
        scale,
        factor: params.summed_mass * scale * scale * scale,
        kernel: PhantomData,
    };
    let sorted =
        Sorted::new(params.support_radius, grid, cell_start, positions).with_images(Images::new(params));
    pairs::for_each(sorted, densities, &pass);
}

struct Density<'a, K> {
    params: &'a Params,
    positions: &'a [Vec4],
    scale: f32,
    factor: f32,
    kernel: PhantomData<K>,
}

impl<K: Kernel> PairSum<3, 1> for Density<'_, K> {
    type Output = Vec2;

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 3] {
        self.positions[j].xyz().to_array()
    }

    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 3]) -> [V; 1] {
        let x = splat::<V>(self.positions[i]);
        #[inline(always)]
        move |other| {
            let d = difference(x, other);
            [K::w(dot(d, d).sqrt() * self.scale)]
        }
    }

    #[inline(always)]
    fn finish(&self, _: usize, [sum]: [f32; 1]) -> Vec2 {
        let density = self.factor * sum;
        Vec2::new(density, self.params.pressure_at(density))
    }
}
