use glam::UVec2;
use rayon::prelude::*;

use crate::cells::Grid;

/// Cells per task.
const CHUNK: usize = 2048;

/// Sorts the entries of each cell by id, and copies the values of active particles in this order.
pub(super) fn reorder_carried<T: Copy + Send + Sync>(
    grid: &Grid,
    cell_start: &[u32],
    entries: &[UVec2],
    carried: &[T],
    mut sorted: &mut [T],
) {
    let cells = grid.cell_count as usize;
    let mut pieces = Vec::new();
    for first in (0..cells).step_by(CHUNK) {
        let bounds = &cell_start[first..=(first + CHUNK).min(cells)];
        let len = (bounds[bounds.len() - 1] - bounds[0]) as usize;
        pieces.push((bounds, sorted.split_off_mut(..len).unwrap_or_default()));
    }
    pieces.into_par_iter().for_each(|(bounds, out)| {
        let mut order = entries[bounds[0] as usize..][..out.len()].to_vec();
        for cell in bounds.windows(2) {
            order[(cell[0] - bounds[0]) as usize..(cell[1] - bounds[0]) as usize]
                .sort_unstable_by_key(|entry| entry.x);
        }
        for (out, entry) in out.iter_mut().zip(order) {
            *out = carried[entry.y as usize];
        }
    });
}

/// Gives removed particles, which are behind the last cell, the value of an emitted one.
pub(super) fn reset_removed<T: Copy>(grid: &Grid, cell_start: &[u32], emitted: &[T], sorted: &mut [T]) {
    let [active, all] = [0, 1].map(|k| cell_start[grid.cell_count as usize + k] as usize);
    sorted[active..all].fill(emitted[0]);
}
