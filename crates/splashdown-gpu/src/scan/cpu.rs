//! The CPU code of the passes. Integer sums wrap and are independent of the order, so the result does not depend on the
//! number of threads.

use rayon::prelude::*;

use super::{ReduceBindings, ScanParams, SingleBindings, SpreadBindings};

/// Blocks per task: 16,384 words, enough to hide the overhead of a task.
const BLOCKS_PER_TASK: usize = 8;

/// The sum of every block of `256 * RUN` counts.
pub(super) fn reduce<const RUN: usize, const MOST: u32>(
    ReduceBindings { params, counts, sums }: ReduceBindings<'_>,
) {
    counts[..params.len as usize].par_chunks(256 * RUN).with_min_len(BLOCKS_PER_TASK).zip(sums).for_each(
        |(block, sum)| *sum = block.iter().fold(0, |sum, count| sum.wrapping_add(*count.min(&MOST))),
    );
}

/// The whole scan, serially.
pub(super) fn single<const MOST: u32>(SingleBindings { params, counts, starts }: SingleBindings<'_>) {
    let len = params.len as usize;
    starts[len] = run::<MOST>(&counts[..len], &mut starts[..len], 0);
}

/// The prefix sums inside every block, offset by the sums of the preceding blocks.
pub(super) fn spread<const RUN: usize, const MOST: u32, const SCANNED: bool>(
    SpreadBindings { params, counts, sums, starts }: SpreadBindings<'_>,
) {
    let ScanParams { len, blocks } = *params;
    let (len, blocks) = (len as usize, blocks as usize);
    let (starts, total) = starts[..=len].split_at_mut(len);
    let mut scanned = Vec::new();
    let offsets = if SCANNED {
        sums
    } else {
        scanned.resize(blocks + 1, 0);
        scanned[blocks] = run::<{ u32::MAX }>(&sums[..blocks], &mut scanned[..blocks], 0);
        &scanned
    };
    total[0] = offsets[blocks];
    counts[..len]
        .par_chunks(256 * RUN)
        .with_min_len(BLOCKS_PER_TASK)
        .zip(starts.par_chunks_mut(256 * RUN))
        .zip(offsets)
        .for_each(|((counts, starts), offset)| {
            run::<MOST>(counts, starts, *offset);
        });
}

/// Writes the sum before each count, starting with `sum`, and returns the sum after the last.
fn run<const MOST: u32>(counts: &[u32], starts: &mut [u32], mut sum: u32) -> u32 {
    for (count, start) in counts.iter().zip(starts) {
        *start = sum;
        sum = sum.wrapping_add((*count).min(MOST));
    }
    sum
}
