use glam::UVec2;
use rayon::prelude::*;

/// Cells per task.
const CHUNK: usize = 2048;

/// Sorts the entries of each cell by id, and copies the values in this order.
pub(super) fn reorder_carried<T: Copy + Send + Sync>(
    cell_start: &[u32],
    entries: &[UVec2],
    carried: &[T],
    sorted: &mut [T],
) {
    let mut rest = sorted;
    let cells = cell_start.len() - 1;
    let mut pieces = Vec::new();
    for first in (0..cells).step_by(CHUNK) {
        let bounds = &cell_start[first..=(first + CHUNK).min(cells)];
        let len = (bounds[bounds.len() - 1] - bounds[0]) as usize;
        pieces.push((bounds, rest.split_off_mut(..len).unwrap_or_default()));
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
