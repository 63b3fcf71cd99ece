use std::marker::PhantomData;

use glam::{Vec2, Vec3, Vec4};

use super::SurfaceNormalsBindings;
use crate::boundary::Images;
use crate::kernel::Kernel;
use crate::pairs::{self, PairSum, Sorted, difference, dot, scaled, splat};
use crate::simd::Register;

pub(super) fn normals<K: Kernel>(buffers: SurfaceNormalsBindings<'_>) {
    let SurfaceNormalsBindings { params, grid, cell_start, sorted_positions: positions, densities, normals } =
        buffers;
    let scale = 1.0 / params.support_radius;
    let pass = Normals::<K> {
        positions,
        densities,
        scale,
        factor: params.summed_mass * (scale * scale) * (scale * scale),
        kernel: PhantomData,
    };
    let sorted =
        Sorted::new(params.support_radius, grid, cell_start, positions).with_images(Images::new(params));
    pairs::for_each(sorted, normals, &pass);
}

struct Normals<'a, K> {
    positions: &'a [Vec4],
    densities: &'a [Vec2],
    scale: f32,
    factor: f32,
    kernel: PhantomData<K>,
}

impl<K: Kernel> PairSum<4, 3> for Normals<'_, K> {
    type Output = Vec4;

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 4] {
        let p = self.positions[j];
        [p.x, p.y, p.z, 1.0 / self.densities[j].x]
    }

    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 4]) -> [V; 3] {
        let x = splat::<V>(self.positions[i]);
        #[inline(always)]
        move |[x_j, y_j, z_j, specific]| {
            let d = difference(x, [x_j, y_j, z_j]);
            scaled(K::g(dot(d, d).sqrt() * self.scale) * specific, d)
        }
    }

    #[inline(always)]
    fn finish(&self, _: usize, sums: [f32; 3]) -> Vec4 {
        self.factor * Vec3::from(sums).extend(0.0)
    }
}
