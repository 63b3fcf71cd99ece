use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use glam::{Vec4, Vec4Swizzles};
use splashdown_gpu::as_atomic;

use super::VolumeBindings;
use crate::kernel::{CubicSpline, Kernel};
use crate::pairs::{self, PairSum, Sorted, difference, dot, splat};
use crate::simd::Register;

pub(super) fn volume(buffers: VolumeBindings<'_>) {
    let VolumeBindings { lattice, grid, cell_start, sorted_positions: positions, samples, local_density } =
        buffers;
    let pass = Volume {
        positions,
        inverse_support: lattice.inverse_support,
        local_density: as_atomic(local_density),
    };
    let sorted = Sorted::new(lattice.support_radius, grid, cell_start, positions)
        .with_images(lattice.walls().images());
    pairs::for_each(sorted, samples, &pass);
}

struct Volume<'a> {
    positions: &'a [Vec4],
    inverse_support: f32,
    /// The second output, as the bits of `f32`: every element is written by one task.
    local_density: &'a [AtomicU32],
}

impl PairSum<3, 2> for Volume<'_> {
    type Output = Vec4;

    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 3] {
        self.positions[j].xyz().to_array()
    }

    #[inline(always)]
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; 3]) -> [V; 2] {
        let x = splat::<V>(self.positions[i]);
        let (zero, one) = (V::splat(0.0), V::splat(1.0));
        let inverse2 = self.inverse_support * self.inverse_support;
        #[inline(always)]
        move |other| {
            let d = difference(other, x);
            let r2 = dot(d, d);
            [CubicSpline::w(r2.sqrt() * self.inverse_support), (one - r2 * inverse2).max(zero)]
        }
    }

    #[inline(always)]
    fn finish(&self, i: usize, [sum, neighbours]: [f32; 2]) -> Vec4 {
        // Without the particle itself.
        self.local_density[i].store((neighbours - 1.0).to_bits(), Relaxed);
        self.positions[i].xyz().extend(1.0 / sum)
    }
}
