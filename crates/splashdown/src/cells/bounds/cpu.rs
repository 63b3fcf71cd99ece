use glam::UVec2;

use super::BoundsBindings;

/// Serial, because the bitonic sort is a baseline only, and this pass is a small part of it.
pub(super) fn bounds(buffers: BoundsBindings<'_>) {
    let BoundsBindings { grid, state, pairs, ids, cell_start, entries: out } = buffers;
    let n = state.run_count as usize;
    let end = grid.cell_count as usize + 1;
    let pairs = &pairs[..n];
    let mut next = 0;
    for (k, pair) in pairs.iter().enumerate() {
        out[k] = UVec2::new(ids[pair.y as usize], pair.y);
        while next <= pair.x as usize {
            cell_start[next] = k as u32;
            next += 1;
        }
    }
    cell_start[next..=end].fill(n as u32);
}
