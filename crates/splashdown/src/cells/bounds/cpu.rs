use glam::UVec2;
use splashdown_gpu::{CpuWork, Slot};

use crate::cells::Grid;
use crate::passes::StepState;

/// Serial: a baseline, and a small part of it.
pub(super) fn bounds(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [grid, state, pairs, cell_start, out] = slots else { unreachable!() };
    let n = state.get::<StepState>().run_count as usize;
    let end = grid.get::<Grid>().cell_count as usize + 1;
    let (pairs, cell_start, out) =
        (&pairs.read::<UVec2>()[..n], cell_start.write::<u32>(), out.write::<u32>());
    let mut next = 0;
    for (k, pair) in pairs.iter().enumerate() {
        out[k] = pair.y;
        while next <= pair.x as usize {
            cell_start[next] = k as u32;
            next += 1;
        }
    }
    cell_start[next..=end].fill(n as u32);
}
