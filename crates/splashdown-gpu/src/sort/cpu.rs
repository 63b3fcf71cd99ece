//! The sorting network on the CPU.
//!
//! rayon's sort is several times faster. The network is the baseline of the thesis and is measured as such, and each of
//! its passes must have the same result on the CPU as on a GPU for any input. Blocks of 512 are sorted by the standard
//! library: the order is total, so the result is unique.

use glam::UVec2;
use rayon::prelude::*;

use super::{BLOCK, SortBindings, SortParams};

/// Pairs per task.
const TASK: usize = 4096;

fn key(pair: &UVec2) -> (u32, u32) {
    (pair.x, pair.y)
}

#[inline(always)]
fn compare(low: &mut UVec2, high: &mut UVec2) {
    let (a, b) = (*low, *high);
    let swap = key(&a) > key(&b);
    *low = if swap { b } else { a };
    *high = if swap { a } else { b };
}

/// Sorts each block of 512.
pub(super) fn blocks(SortBindings { params, pairs }: SortBindings<'_>) {
    pairs[..params.len as usize]
        .par_chunks_mut(BLOCK as usize)
        .for_each(|block| block.sort_unstable_by_key(key));
}

/// The last nine steps of a merge, inside blocks of 512.
pub(super) fn merge(SortBindings { params, pairs }: SortBindings<'_>) {
    pairs[..params.len as usize].par_chunks_mut(BLOCK as usize).for_each(|block| {
        let mut span = BLOCK as usize;
        while span > 1 {
            for part in block.chunks_mut(span) {
                let (low, high) = part.split_at_mut(part.len().min(span / 2));
                low.iter_mut().zip(high).for_each(|(low, high)| compare(low, high));
            }
            span /= 2;
        }
    });
}

/// One step over spans longer than a block.
pub(super) fn step(SortBindings { params, pairs }: SortBindings<'_>) {
    let SortParams { len, span, flip } = *params;
    let half = span as usize / 2;
    pairs[..len as usize].par_chunks_mut(span as usize).for_each(|part| {
        let (low, high) = part.split_at_mut(part.len().min(half));
        if flip == 1 {
            // The first element of `high` is compared with the last of `low`. If `high` is truncated, the first elements
            // of `low` are compared with padding.
            let met = half - high.len();
            let low = low.get_mut(met..).unwrap_or_default();
            low.par_iter_mut().rev().zip(high).with_min_len(TASK).for_each(|(low, high)| compare(low, high));
        } else {
            low.par_iter_mut().zip(high).with_min_len(TASK).for_each(|(low, high)| compare(low, high));
        }
    });
}
