use glam::UVec2;
use rayon::prelude::*;
use splashdown_gpu::{CpuWork, Slot};

use crate::cells::Grid;
use crate::state::StepState;

pub(super) fn keys(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [grid, state, cell_counts, pairs] = slots else { unreachable!() };
    let n = state.get::<StepState>().run_count as usize;
    let cells = &cell_counts.read::<u32>()[grid.get::<Grid>().cell_count as usize + 1..][..n];
    pairs.write::<UVec2>()[..n]
        .par_iter_mut()
        .with_min_len(4096)
        .zip(cells)
        .enumerate()
        .for_each(|(i, (pair, &cell))| *pair = UVec2::new(cell, i as u32));
}
