use glam::{Vec3, Vec4};
use rayon::prelude::*;
use splashdown_gpu::{CpuWork, Slot};

use crate::cells::Grid;
use crate::surface::gather::{Columns, Gathered, LANES, dispatched};
use crate::surface::params::{Lattice, Status};
use crate::surface::parts::by_starts;
use crate::surface::spline::spline;

/// Vertices that share a gathered neighbourhood.
const TOGETHER: usize = 32;

pub(super) fn weigh(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [lattice, grid, status, _, starts, cell_start, samples, crowding, positions] = slots else {
        unreachable!()
    };
    let (lattice, grid) = (lattice.get::<Lattice>(), grid.get::<Grid>());
    let blocks = status.get::<Status>().blocks as usize;
    let (cell_start, samples, crowding) = (cell_start.read(), samples.read::<Vec4>(), crowding.read());
    let pieces = by_starts(positions.write::<Vec4>(), &starts.read::<u32>()[..=blocks]);
    // A block's vertices come layer by layer: few together have a smaller neighbourhood than all.
    let parts: Vec<_> = pieces.into_iter().flat_map(|piece| piece.chunks_mut(TOGETHER)).collect();
    parts.into_par_iter().with_min_len(8).for_each_init(Gathered::default, |near, vertices| {
        let low = vertices.iter().fold(Vec3::MAX, |low, v| low.min(v.truncate()));
        let high = vertices.iter().fold(Vec3::MIN, |high, v| high.max(v.truncate()));
        let reach = lattice.support_radius;
        near.fill(&grid, cell_start, samples, crowding, low - reach, high + reach);
        for vertex in vertices {
            let (sum, total) = sums(near.columns(), vertex.truncate(), lattice.inverse_support);
            // A vertex that no particle reaches, in the middle of a very long edge, stays.
            let s = (sum / total.max(1e-12) / 13.0).clamp(0.0, 1.0);
            vertex.w = s * s * s * (s * (6.0 * s - 15.0) + 10.0);
        }
    });
}

dispatched! {
    /// The sums of each particle's share at `p`, with and without its crowding, in eight lanes.
    fn sums(near: Columns<'_>, p: Vec3, inverse_support: f32) -> (f32, f32) {
        let (mut sum, mut total) = ([0.0_f32; LANES], [0.0_f32; LANES]);
        let places = near.x.chunks_exact(LANES).zip(near.y.chunks_exact(LANES)).zip(near.z.chunks_exact(LANES));
        let shares = near.w.chunks_exact(LANES).zip(near.extra.chunks_exact(LANES));
        for (((x, y), z), (volume, crowding)) in places.zip(shares) {
            for lane in 0..LANES {
                let (dx, dy, dz) = (x[lane] - p.x, y[lane] - p.y, z[lane] - p.z);
                let share = volume[lane] * spline((dx * dx + dy * dy + dz * dz).sqrt() * inverse_support);
                sum[lane] += share * crowding[lane];
                total[lane] += share;
            }
        }
        (sum.iter().sum(), total.iter().sum())
    }
}
