use glam::{Vec4, Vec4Swizzles};

use super::WeightsBindings;
use crate::boundary::Reflection;
use crate::kernel::{CubicSpline, Kernel};
use crate::pairs::{self, PairSum, Sorted, difference, dot, reflected_matrix, reflected_point, splat};
use crate::simd::Register;

pub(super) fn weights(buffers: WeightsBindings<'_>) {
    let WeightsBindings {
        lattice,
        grid,
        cell_start,
        sorted_positions: positions,
        kernel_centres: centres,
        kernel_matrices,
        samples,
    } = buffers;
    let inverse2 = lattice.inverse_support * lattice.inverse_support;
    let pass = Weights { positions, centres, matrices: kernel_matrices.as_chunks().0, inverse2 };
    let sorted = Sorted::new(lattice.support_radius, grid, cell_start, positions)
        .with_images(lattice.walls().images());
    pairs::for_each(sorted, samples, &pass);
}

struct Weights<'a> {
    positions: &'a [Vec4],
    centres: &'a [Vec4],
    matrices: &'a [[Vec4; 2]],
    /// 1 / H^2
    inverse2: f32,
}

/// Columns: position, centre, matrix.
impl PairSum<12, 1> for Weights<'_> {
    type Output = Vec4;

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 12] {
        let (p, c, [first, second]) = (self.positions[j], self.centres[j], self.matrices[j]);
        let [xx, xy, xz, yy] = first.to_array();
        [p.x, p.y, p.z, c.x, c.y, c.z, xx, xy, xz, yy, second.x, second.y]
    }

    #[inline(always)]
    fn reflect<V: Register>(&self, by: &Reflection, values: [V; 12]) -> [V; 12] {
        let [x, y, z, a, b, c, xx, xy, xz, yy, yz, zz] = values;
        let ([x, y, z], [a, b, c]) = (reflected_point(by, [x, y, z]), reflected_point(by, [a, b, c]));
        let [xx, xy, xz, yy, yz, zz] = reflected_matrix(by, [xx, xy, xz, yy, yz, zz]);
        [x, y, z, a, b, c, xx, xy, xz, yy, yz, zz]
    }

    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 12]) -> [V; 1] {
        let (x, centre) = (splat::<V>(self.positions[i]), splat::<V>(self.centres[i]));
        let (zero, one) = (V::splat(0.0), V::splat(1.0));
        #[inline(always)]
        move |[x_j, y_j, z_j, a, b, c, xx, xy, xz, yy, yz, zz]| {
            let d = difference([x_j, y_j, z_j], x);
            let rest = (one - dot(d, d) * self.inverse2) * 4.0;
            let window = rest.if_less(one, rest, one).max(zero);
            let [a, b, c] = difference([a, b, c], centre);
            let q2 = (xx * a + (xy * b + xz * c) * 2.0) * a + (yy * b + yz * c * 2.0) * b + zz * c * c;
            [window * CubicSpline::w(q2.max(zero).sqrt())]
        }
    }

    /// The weights of particles inside the fluid are known.
    #[inline(always)]
    fn wants(&self, i: usize) -> bool {
        self.centres[i].w == 0.0
    }

    #[inline(always)]
    fn finish(&self, i: usize, [sum]: [f32; 1]) -> Vec4 {
        let centre = self.centres[i];
        centre.xyz().extend(if self.wants(i) { 1.0 / sum } else { -centre.w })
    }
}
