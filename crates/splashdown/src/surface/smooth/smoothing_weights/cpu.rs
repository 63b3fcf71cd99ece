use glam::{Vec3, Vec4, Vec4Swizzles};
use splashdown_gpu::{CpuWork, Slot};

use crate::kernel::{CubicSpline, Kernel};
use crate::pairs::{self, PointSum, Sorted, difference, dot};
use crate::simd::Register;
use crate::surface::params::{Lattice, Status};

pub(super) fn smoothing_weights(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [lattice, grid, status, starts, cell_start, samples, local_density, positions] = slots else {
        unreachable!()
    };
    let (lattice, grid) = (lattice.get::<Lattice>(), grid.get());
    let blocks = status.get::<Status>().blocks as usize;
    let positions = positions.write::<Vec4>();
    let vertices = (starts.read::<u32>()[blocks] as usize).min(positions.len());
    let points: Vec<Vec3> = positions[..vertices].iter().map(|vertex| vertex.xyz()).collect();
    let samples = samples.read();
    let sorted = Sorted::new(lattice.support_radius, &grid, cell_start.read(), samples);
    let pass =
        Density { samples, local_density: local_density.read(), inverse_support: lattice.inverse_support };
    let sums = pairs::sums_at(sorted, &points, &pass);
    for (vertex, [sum, total]) in positions.iter_mut().zip(sums) {
        // Total is zero at a vertex beyond the reach of all particles, on a very long edge: it does
        // not move.
        let s = (sum / total.max(1e-12) / 13.0).clamp(0.0, 1.0);
        vertex.w = s * s * s * (s * (6.0 * s - 15.0) + 10.0);
    }
}

/// The local density of the particles, interpolated.
struct Density<'a> {
    /// Position and volume.
    samples: &'a [Vec4],
    local_density: &'a [f32],
    inverse_support: f32,
}

impl PointSum<5, 2> for Density<'_> {
    #[inline(always)]
    fn load(&self, j: usize) -> [f32; 5] {
        let [x, y, z, volume] = self.samples[j].to_array();
        [x, y, z, volume, self.local_density[j]]
    }

    #[inline(always)]
    fn pair<V: Register>(&self, x: [V; 3]) -> impl Fn([V; 5]) -> [V; 2] {
        #[inline(always)]
        move |[x_j, y_j, z_j, volume, local_density]| {
            let d = difference([x_j, y_j, z_j], x);
            let weight = volume * CubicSpline::w(dot(d, d).sqrt() * self.inverse_support);
            [weight * local_density, weight]
        }
    }
}
