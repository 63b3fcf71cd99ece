use glam::{Vec3, Vec4, Vec4Swizzles};

use super::ShapesBindings;
use crate::boundary::Reflection;
use crate::pairs::{
    self, PairSum, Sorted, difference, dot, reflected, reflected_matrix, reflected_point, splat,
};
use crate::simd::Register;
use crate::surface::anisotropy::matrix::{determinant, inverted, plus, squared};
use crate::surface::anisotropy::{MAX_SHIFT, MAX_SIZE};

/// Part of the deviation from the neighbours' offset that is removed.
const SMOOTHING: f32 = 0.9;
/// Difference of offsets, in support radii, beyond which neighbours are in another layer.
const OTHER_LAYER: f32 = 0.25;
/// Variance along each axis in the bulk, in squares of the support radius.
const BULK_VARIANCE: f32 = 0.1446;
/// Square of the half-axis of a kernel whose neighbours have no extent along it.
const FLATTEST: f32 = 0.35;
/// Where f saturates: k.
const SATURATION: f32 = 0.25;
/// Number of neighbours, relative to that in the bulk, above which a kernel is not a ball at all.
const FEW: f32 = 0.18;
/// A particle with more neighbours, relative to the number in the bulk, a smaller square of the offset, and a larger determinant
/// of the covariance, relative to the bulk, is inside the fluid: its kernel is a ball. The last one excludes dense sheets.
const INTERIOR_NUMBER: f32 = 0.93;
const INTERIOR_OFFSET2: f32 = 0.0025;
const INTERIOR_DETERMINANT: f32 = 0.5 * BULK_VARIANCE * BULK_VARIANCE * BULK_VARIANCE;

pub(super) fn shapes(buffers: ShapesBindings<'_>) {
    let ShapesBindings {
        lattice,
        grid,
        cell_start,
        sorted_positions: positions,
        neighbour_moments,
        kernel_centres,
        kernel_matrices,
    } = buffers;
    let pass = Shapes {
        positions,
        moments: neighbour_moments.as_chunks().0,
        support_radius: lattice.support_radius,
        inverse_support: lattice.inverse_support,
        bulk_number: lattice.bulk_number,
        lone_size: lattice.lone_size,
    };
    let sorted = Sorted::new(lattice.support_radius, grid, cell_start, positions)
        .with_images(lattice.walls().images());
    pairs::for_each(sorted, (kernel_centres, kernel_matrices.as_chunks_mut::<2>().0), &pass);
}

struct Shapes<'a> {
    positions: &'a [Vec4],
    moments: &'a [[Vec4; 3]],
    support_radius: f32,
    inverse_support: f32,
    bulk_number: f32,
    lone_size: f32,
}

/// Columns: position, offset, number, covariance.
impl PairSum<13, 11> for Shapes<'_> {
    type Output = (Vec4, [Vec4; 2]);

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 13] {
        let (p, [mean, first, second]) = (self.positions[j], self.moments[j]);
        let (offset, number) = (mean.xyz(), mean.w);
        let [xx, xy, xz, yy] = first.to_array();
        [p.x, p.y, p.z, offset.x, offset.y, offset.z, number, xx, xy, xz, yy, second.x, second.y]
    }

    #[inline(always)]
    fn reflect<V: Register>(&self, by: &Reflection, values: [V; 13]) -> [V; 13] {
        let [x, y, z, a, b, c, number, xx, xy, xz, yy, yz, zz] = values;
        let ([x, y, z], [a, b, c]) = (reflected_point(by, [x, y, z]), reflected(by, [a, b, c]));
        let [xx, xy, xz, yy, yz, zz] = reflected_matrix(by, [xx, xy, xz, yy, yz, zz]);
        [x, y, z, a, b, c, number, xx, xy, xz, yy, yz, zz]
    }

    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 13]) -> [V; 11] {
        let (x, offset) = (splat::<V>(self.positions[i]), splat::<V>(self.moments[i][0]));
        let (zero, one) = (V::splat(0.0), V::splat(1.0));
        let inverse2 = self.inverse_support * self.inverse_support;
        const SIMILARITY: f32 = 1.0 / (OTHER_LAYER * OTHER_LAYER);
        #[inline(always)]
        move |[x_j, y_j, z_j, a, b, c, number, xx, xy, xz, yy, yz, zz]| {
            let d = difference([x_j, y_j, z_j], x);
            let q2 = dot(d, d) * inverse2;
            let other = difference([a, b, c], offset);
            let similar = (one - dot(other, other) * SIMILARITY).max(zero);
            let w = q2.if_less(one, one - q2 * q2.sqrt(), zero) * (similar * similar);
            [w, w * a, w * b, w * c, w * number, w * xx, w * xy, w * xz, w * yy, w * yz, w * zz]
        }
    }

    #[inline(always)]
    fn wants(&self, i: usize) -> bool {
        let [mean, first, second] = self.moments[i];
        let [xx, xy, xz, yy] = first.to_array();
        mean.w < INTERIOR_NUMBER * self.bulk_number
            || mean.xyz().length_squared() > INTERIOR_OFFSET2
            || determinant([xx, xy, xz, yy, second.x, second.y]) < INTERIOR_DETERMINANT
    }

    #[inline(always)]
    fn finish(&self, i: usize, sums: [f32; 11]) -> (Vec4, [Vec4; 2]) {
        let [total, x, y, z, number, xx, xy, xz, yy, yz, zz] = sums;
        if !self.wants(i) {
            let element = self.inverse_support * self.inverse_support;
            let radius2 = self.support_radius * self.support_radius;
            return (
                self.positions[i].xyz().extend(self.moments[i][2].z),
                [Vec4::new(element, 0.0, 0.0, element), Vec4::new(0.0, element, radius2, 0.0)],
            );
        }
        let inverse = 1.0 / total;
        let own = self.moments[i][0];
        let shift = SMOOTHING * (own.xyz() - inverse * Vec3::new(x, y, z));
        let shift = shift * (MAX_SHIFT / shift.length().max(MAX_SHIFT));
        let centre = self.positions[i].xyz() + self.support_radius * shift;

        // How far the kernel may be from a ball.
        let t = ((own.w - 1.0) / (FEW * self.bulk_number)).clamp(0.0, 1.0);
        let size = (self.bulk_number / (inverse * number)).sqrt().clamp(1.0, MAX_SIZE);
        let size = self.lone_size + t * (size - self.lone_size);
        // The squares of the half-axes are (a M^2 + b) / (M^2 + k) for A = (M^2 + k) / (a M^2 + b).
        let a = 1.0 + t * (FLATTEST + (1.0 - FLATTEST) * (1.0 + SATURATION) - 1.0);
        let b = SATURATION * (1.0 + t * (FLATTEST - 1.0));
        let relative = [xx, xy, xz, yy, yz, zz].map(|sum| sum * (inverse / BULK_VARIANCE));
        let rest = inverted(plus(squared(relative), b / a)).map(|element| element * (SATURATION - b / a));
        let scale = self.inverse_support / size;
        let scale = scale * scale / a;
        let [xx, xy, xz, yy, yz, zz] = plus(rest, 1.0).map(|element| scale * element);
        (centre.extend(0.0), [Vec4::new(xx, xy, xz, yy), Vec4::new(yz, zz, 1.0 / scale, 0.0)])
    }
}
