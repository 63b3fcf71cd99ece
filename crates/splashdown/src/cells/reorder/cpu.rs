use glam::Vec4;
use rayon::prelude::*;

use super::ReorderBindings;

/// Cells per task.
const CHUNK: usize = 2048;

/// The output of a task. The places of consecutive cells are contiguous, so that the tasks own disjoint pieces.
struct Piece<'a> {
    /// The begins of its cells in the sorted arrays, and the end of the last.
    bounds: &'a [u32],
    positions: &'a mut [Vec4],
    velocities: &'a mut [Vec4],
    ids: &'a mut [u32],
}

/// Sorts the few entries of every cell instead of counting smaller ids: the same order with less work.
pub(super) fn reorder(buffers: ReorderBindings<'_>) {
    let ReorderBindings {
        cell_start,
        entries: arrivals,
        positions,
        velocities,
        sorted_positions,
        sorted_velocities,
        sorted_ids,
        ..
    } = buffers;
    let mut rest = (sorted_positions, sorted_velocities, sorted_ids);
    let mut pieces = Vec::new();
    let cells = cell_start.len() - 1;
    for first in (0..cells).step_by(CHUNK) {
        let bounds = &cell_start[first..=(first + CHUNK).min(cells)];
        let len = (bounds[bounds.len() - 1] - bounds[0]) as usize;
        if len > 0 {
            pieces.push(Piece {
                bounds,
                positions: rest.0.split_off_mut(..len).unwrap_or_default(),
                velocities: rest.1.split_off_mut(..len).unwrap_or_default(),
                ids: rest.2.split_off_mut(..len).unwrap_or_default(),
            });
        }
    }
    pieces.into_par_iter().for_each(|piece| {
        let begin = piece.bounds[0];
        let mut order = arrivals[begin as usize..][..piece.ids.len()].to_vec();
        for bounds in piece.bounds.windows(2) {
            order[(bounds[0] - begin) as usize..(bounds[1] - begin) as usize].sort_unstable_by_key(|e| e.x);
        }
        for (k, entry) in order.iter().enumerate() {
            let i = entry.y as usize;
            piece.positions[k] = positions[i];
            piece.velocities[k] = velocities[i];
            piece.ids[k] = entry.x;
        }
    });
}
