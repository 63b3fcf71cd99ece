use glam::{Vec3, Vec4, Vec4Swizzles};

use super::SmoothingWeightsBindings;
use crate::kernel::{CubicSpline, Kernel};
use crate::pairs::{self, PointSum, Sorted, difference, dot};
use crate::simd::Register;

pub(super) fn smoothing_weights(buffers: SmoothingWeightsBindings<'_>) {
    let SmoothingWeightsBindings { lattice, samples, local_density, vertex_positions: positions, .. } =
        buffers;
    let vertices = buffers.vertex_starts[buffers.status.blocks as usize] as usize;
    let vertices = vertices.min(positions.len());
    let points: Vec<Vec3> = positions[..vertices].iter().map(|vertex| vertex.xyz()).collect();
    let sorted = Sorted::new(lattice.support_radius, buffers.grid, buffers.cell_start, samples);
    let pass = Density { samples, local_density, inverse_support: lattice.inverse_support };
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
        [x, y, z, volume.abs(), self.local_density[j]]
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
