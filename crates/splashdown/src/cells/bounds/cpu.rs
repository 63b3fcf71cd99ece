use glam::UVec2;
use splashdown_gpu::{CpuWork, Slot};

use crate::cells::Grid;
use crate::state::StepState;

/// Serial: a baseline, and a small part of it.
pub(super) fn bounds(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [grid, state, pairs, ids, cell_start, out] = slots else { unreachable!() };
    let n = state.get::<StepState>().run_count as usize;
    let end = grid.get::<Grid>().cell_count as usize + 1;
    let (pairs, ids) = (&pairs.read::<UVec2>()[..n], ids.read::<u32>());
    let (cell_start, out) = (cell_start.write::<u32>(), out.write::<UVec2>());
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
