use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use glam::{Vec3, Vec4, Vec4Swizzles};
use splashdown_gpu::as_atomic;

use super::MomentsBindings;
use crate::kernel::{CubicSpline, Kernel};
use crate::pairs::{self, PairSum, Sorted, difference, dot, splat};
use crate::simd::Register;

pub(super) fn moments(buffers: MomentsBindings<'_>) {
    let MomentsBindings {
        lattice,
        grid,
        cell_start,
        sorted_positions: positions,
        neighbour_moments,
        local_density,
    } = buffers;
    let pass = Moments {
        positions,
        inverse_support: lattice.inverse_support,
        local_density: as_atomic(local_density),
    };
    let sorted = Sorted::new(lattice.support_radius, grid, cell_start, positions)
        .with_images(lattice.walls().images());
    pairs::for_each(sorted, neighbour_moments.as_chunks_mut::<3>().0, &pass);
}

struct Moments<'a> {
    positions: &'a [Vec4],
    inverse_support: f32,
    /// The second output, as the bits of `f32`: every element is written by one task.
    local_density: &'a [AtomicU32],
}

impl PairSum<3, 12> for Moments<'_> {
    type Output = [Vec4; 3];

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 3] {
        self.positions[j].xyz().to_array()
    }

    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 3]) -> [V; 12] {
        let x = splat::<V>(self.positions[i]);
        let (zero, one) = (V::splat(0.0), V::splat(1.0));
        #[inline(always)]
        move |other| {
            let [a, b, c] = difference(other, x).map(|d| d * self.inverse_support);
            let q2 = dot([a, b, c], [a, b, c]);
            let q = q2.sqrt();
            let w = q2.if_less(one, one - q2 * q, zero);
            let [wa, wb, wc] = [w * a, w * b, w * c];
            [
                (one - q2).max(zero),
                CubicSpline::w(q),
                w,
                wa,
                wb,
                wc,
                wa * a,
                wa * b,
                wa * c,
                wb * b,
                wb * c,
                wc * c,
            ]
        }
    }

    #[inline(always)]
    fn finish(&self, i: usize, sums: [f32; 12]) -> [Vec4; 3] {
        let [neighbours, kernels, number, x, y, z, xx, xy, xz, yy, yz, zz] = sums;
        // Without the particle itself.
        self.local_density[i].store((neighbours - 1.0).to_bits(), Relaxed);
        let inverse = 1.0 / number;
        let m = inverse * Vec3::new(x, y, z);
        let covariance = |sum: f32, a: f32, b: f32| inverse * sum - a * b;
        [
            m.extend(number),
            Vec4::new(
                covariance(xx, m.x, m.x),
                covariance(xy, m.x, m.y),
                covariance(xz, m.x, m.z),
                covariance(yy, m.y, m.y),
            ),
            Vec4::new(covariance(yz, m.y, m.z), covariance(zz, m.z, m.z), 1.0 / kernels, 0.0),
        ]
    }
}
