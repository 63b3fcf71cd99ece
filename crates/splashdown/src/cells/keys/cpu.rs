use glam::UVec2;
use rayon::prelude::*;

use super::KeysBindings;

pub(super) fn keys(buffers: KeysBindings<'_>) {
    let KeysBindings { grid, state, cell_counts, pairs } = buffers;
    let n = state.run_count as usize;
    let cells = &cell_counts[grid.cell_count as usize + 1..][..n];
    pairs[..n]
        .par_iter_mut()
        .with_min_len(4096)
        .zip(cells)
        .enumerate()
        .for_each(|(i, (pair, &cell))| *pair = UVec2::new(cell, i as u32));
}
