use glam::{Vec3, Vec4};
use rayon::prelude::*;

use super::RelaxBindings;

pub(super) fn relax(buffers: RelaxBindings<'_>) {
    let RelaxBindings { lattice, status, one_ring_starts, one_rings, before, after } = buffers;
    let vertices = status.vertices as usize;
    let walls = lattice.walls();
    let starts = &one_ring_starts[..=vertices];
    let after = &mut after[..vertices];
    after.par_iter_mut().zip(starts.par_windows(2)).with_min_len(2048).enumerate().for_each(
        |(vertex, (after, range))| {
            let own = before[vertex];
            let ring = &one_rings[range[0] as usize..range[1] as usize];
            let (mut sum, mut free, mut pinned) = (Vec4::ZERO, 0_u32, 0_u32);
            for pair in ring {
                let at = before[pair.x as usize];
                if at.w == 0.0 {
                    pinned += 1;
                } else if !walls.touch(at.truncate()) {
                    // Relative to the vertex, which avoids cancellation far from the origin.
                    sum += at - own;
                    free += 1;
                }
            }
            // Pinned neighbours hold the vertex, or it would move onto the few others and turn triangles over.
            let share = free as f32 / (free + pinned).max(1) as f32;
            let step: Vec3 = sum.truncate() * (own.w * share * share / free.max(1) as f32);
            *after = walls.slid(own.truncate(), step, lattice.wall_margin).extend(own.w);
        },
    );
}
