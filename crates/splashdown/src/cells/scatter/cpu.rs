use std::sync::atomic::Ordering::Relaxed;

use rayon::prelude::*;
use splashdown_gpu::as_atomic;

use super::ScatterBindings;
use crate::cells::cell_counts;
use crate::state::finish_step;

const CHUNK: usize = 4096;

pub(super) fn scatter(buffers: ScatterBindings<'_>) {
    let ScatterBindings { params, grid, state, counters, cell_counts, cell_start, ids, entries: out } =
        buffers;
    finish_step(params, state, counters);
    let n = cell_start[grid.cell_count as usize + 1] as usize;
    let (counts, cells) = cell_counts::split(grid, cell_counts);
    // Every place is written once. Relaxed atomic stores cost as much as plain ones and allow several threads.
    let out = as_atomic(out);
    let chunks = cells[..n].par_chunks(CHUNK).zip(ids[..n].par_chunks(CHUNK));
    chunks.enumerate().for_each(|(chunk, (cells, ids))| {
        let mut i = (chunk * CHUNK) as u32;
        let mut ids = ids.iter();
        // Consecutive particles of the same cell decrement its count together.
        for run in cells.chunk_by(|a, b| a == b) {
            let (cell, len) = (run[0] as usize, run.len());
            let left = counts[cell].fetch_sub(len as u32, Relaxed);
            let first = (cell_start[cell + 1] - left) as usize;
            for (slot, id) in (first..).zip(ids.by_ref().take(len)) {
                out[2 * slot].store(*id, Relaxed);
                out[2 * slot + 1].store(i, Relaxed);
                i += 1;
            }
        }
    });
}
