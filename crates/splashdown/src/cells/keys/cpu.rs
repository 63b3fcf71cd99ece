use glam::UVec2;
use rayon::prelude::*;
use splashdown_gpu::{CpuWork, Slot};

use crate::passes::StepState;

pub(super) fn keys(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [state, cell_rank, pairs] = slots else { unreachable!() };
    let n = state.get::<StepState>().run_count as usize;
    let cells = cell_rank.read::<UVec2>()[..n].par_iter().with_min_len(4096);
    pairs.write::<UVec2>()[..n]
        .par_iter_mut()
        .zip(cells)
        .enumerate()
        .for_each(|(i, (pair, cell))| *pair = UVec2::new(cell.x, i as u32));
}
