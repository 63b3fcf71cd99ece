use std::marker::PhantomData;

use glam::{Vec3, Vec4};

use super::SmoothNormalsBindings;
use crate::boundary::{Images, Reflection};
use crate::kernel::Kernel;
use crate::pairs::{self, PairSum, Sorted, difference, dot, reflected, reflected_point, splat};
use crate::simd::Register;

pub(super) fn smooth_normals<K: Kernel>(buffers: SmoothNormalsBindings<'_>) {
    let SmoothNormalsBindings {
        params,
        grid,
        cell_start,
        sorted_positions: positions,
        normals,
        smooth_normals,
    } = buffers;
    let pass =
        SmoothNormals::<K> { positions, normals, scale: 1.0 / params.support_radius, kernel: PhantomData };
    let sorted =
        Sorted::new(params.support_radius, grid, cell_start, positions).with_images(Images::new(params));
    pairs::for_each(sorted, smooth_normals, &pass);
}

struct SmoothNormals<'a, K> {
    positions: &'a [Vec4],
    normals: &'a [Vec4],
    scale: f32,
    kernel: PhantomData<K>,
}

impl<K: Kernel> PairSum<6, 4> for SmoothNormals<'_, K> {
    type Output = Vec4;

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 6] {
        let (p, n) = (self.positions[j], self.normals[j]);
        [p.x, p.y, p.z, n.x, n.y, n.z]
    }

    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 6]) -> [V; 4] {
        let x = splat::<V>(self.positions[i]);
        #[inline(always)]
        move |[x_j, y_j, z_j, a, b, c]| {
            let d = difference(x, [x_j, y_j, z_j]);
            let w = K::w(dot(d, d).sqrt() * self.scale);
            [w * a, w * b, w * c, w]
        }
    }

    #[inline(always)]
    fn reflect<V: Register>(&self, by: &Reflection, [x, y, z, a, b, c]: [V; 6]) -> [V; 6] {
        let ([x, y, z], [a, b, c]) = (reflected_point(by, [x, y, z]), reflected(by, [a, b, c]));
        [x, y, z, a, b, c]
    }

    #[inline(always)]
    fn finish(&self, _: usize, [a, b, c, weight]: [f32; 4]) -> Vec4 {
        (Vec3::new(a, b, c) / weight).extend(0.0)
    }
}
