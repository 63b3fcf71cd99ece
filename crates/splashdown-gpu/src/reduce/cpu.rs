//! The same joins in the same order as the WGSL, so that both executors give the same bits.

use rayon::prelude::*;

use super::{Element, LARGEST, ReduceParams, SMALLEST, SUM};
use crate::{CpuWork, Slot};

/// Blocks per task: 16,384 elements.
const BLOCKS_PER_TASK: usize = 4;

/// One result for every block of `256 * run` values.
pub(super) fn reduce<T: Element, const OPERATION: u32>(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [params, values, results] = slots else { unreachable!("three bindings") };
    let ReduceParams { len, run, blocks } = params.get();
    let values = &values.read::<T>()[..len as usize];
    let results = &mut results.write::<T>()[..blocks as usize];
    let block_len = 256 * run as usize;
    results.par_iter_mut().with_min_len(BLOCKS_PER_TASK).enumerate().for_each(|(block, result)| {
        let end = values.len().min((block + 1) * block_len);
        *result = join_block::<T, OPERATION>(&values[block * block_len..end]);
    });
}

fn join_block<T: Element, const OPERATION: u32>(block: &[T]) -> T {
    let neutral = match OPERATION {
        SMALLEST => T::splat(f32::MAX),
        LARGEST => T::splat(f32::MIN),
        _ => T::splat(0.0),
    };
    let mut lanes = [neutral; 256];
    for row in block.chunks(256) {
        for (lane, value) in lanes.iter_mut().zip(row) {
            *lane = join::<T, OPERATION>(*lane, *value);
        }
    }
    let join_all = |values: &[T]| values[1..].iter().fold(values[0], |a, b| join::<T, OPERATION>(a, *b));
    let rows: [T; 16] = std::array::from_fn(|row| join_all(&lanes[row * 16..][..16]));
    join_all(&rows)
}

#[inline(always)]
fn join<T: Element, const OPERATION: u32>(a: T, b: T) -> T {
    match OPERATION {
        SUM => a.plus(b),
        SMALLEST => a.least(b),
        _ => a.most(b),
    }
}
