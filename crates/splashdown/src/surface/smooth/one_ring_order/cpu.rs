use rayon::prelude::*;

use super::OneRingOrderBindings;
use crate::surface::parts::by_starts;

/// Vertices per task.
const CHUNK: usize = 4096;

pub(super) fn one_ring_order(buffers: OneRingOrderBindings<'_>) {
    let OneRingOrderBindings { status, one_ring_starts, one_rings } = buffers;
    let starts = &one_ring_starts[..=status.vertices as usize];
    let mut borders: Vec<u32> = starts.iter().step_by(CHUNK).copied().collect();
    borders.push(starts[starts.len() - 1]);
    let pieces = by_starts(one_rings, &borders);
    pieces.into_par_iter().enumerate().for_each(|(chunk, one_rings)| {
        let first = chunk * CHUNK;
        let starts = &starts[first.min(starts.len() - 1)..=(first + CHUNK).min(starts.len() - 1)];
        for range in starts.windows(2) {
            let ring = &mut one_rings[(range[0] - starts[0]) as usize..(range[1] - starts[0]) as usize];
            ring.sort_unstable_by_key(|pair| pair.x);
        }
    });
}
