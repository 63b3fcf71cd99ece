use rayon::prelude::*;
use splashdown_gpu::{CpuWork, Slot};

use crate::passes::StepState;

/// Cells per task.
const CHUNK: usize = 2048;

/// Sorts every cell's few entries in place of counting: the same order with less work.
pub(super) fn order(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [state, _cell_rank, cell_start, arrivals, ids, order] = slots else { unreachable!() };
    let n = state.get::<StepState>().run_count as usize;
    let (cell_start, ids) = (cell_start.read::<u32>(), ids.read::<u32>());
    let (arrivals, mut rest) = (&arrivals.read::<u32>()[..n], &mut order.write::<u32>()[..n]);
    if n == 0 {
        return;
    }
    // The places of a run of cells are contiguous, so the tasks own disjoint pieces.
    let mut tasks = Vec::new();
    let cells = cell_start.len() - 1;
    for first in (0..cells).step_by(CHUNK) {
        let last = (first + CHUNK).min(cells);
        let (begin, end) = (cell_start[first] as usize, cell_start[last] as usize);
        let (piece, tail) = rest.split_at_mut(end - begin);
        rest = tail;
        if !piece.is_empty() {
            tasks.push((first, last, begin, piece));
        }
    }
    tasks.into_par_iter().for_each(|(first, last, begin, piece)| {
        piece.copy_from_slice(&arrivals[begin..begin + piece.len()]);
        for bounds in cell_start[first..=last].windows(2) {
            piece[bounds[0] as usize - begin..bounds[1] as usize - begin]
                .sort_unstable_by_key(|&i| ids[i as usize]);
        }
    });
}
