use glam::{Vec3, Vec4};
use rayon::prelude::*;

use super::RelaxBindings;

pub(super) fn relax(buffers: RelaxBindings<'_>) {
    let RelaxBindings { status, one_ring_starts, one_rings, before, after } = buffers;
    let vertices = status.vertices as usize;
    let starts = &one_ring_starts[..=vertices];
    let after = &mut after[..vertices];
    after.par_iter_mut().zip(starts.par_windows(2)).with_min_len(2048).enumerate().for_each(
        |(vertex, (after, range))| {
            let own = before[vertex];
            let ring = &one_rings[range[0] as usize..range[1] as usize];
            // Relative to the vertex, which avoids cancellation far from the origin.
            let sum = ring.iter().fold(Vec4::ZERO, |sum, pair| sum + (before[pair.x as usize] - own));
            let step: Vec3 = sum.truncate() * (own.w / ring.len().max(1) as f32);
            *after = (own.truncate() + step).extend(own.w);
        },
    );
}
