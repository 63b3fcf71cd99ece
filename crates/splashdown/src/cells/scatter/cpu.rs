use std::sync::atomic::Ordering::Relaxed;

use glam::UVec2;
use rayon::prelude::*;
use splashdown_gpu::{CpuWork, Slot};

use crate::passes::StepState;

pub(super) fn scatter(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [state, cell_rank, cell_start, out] = slots else { unreachable!() };
    let n = state.get::<StepState>().run_count as usize;
    let (cell_rank, cell_start, out) = (cell_rank.read::<UVec2>(), cell_start.read::<u32>(), out.atomics());
    // Every place is written once; relaxed atomic stores are plain ones that two threads may make side by side.
    cell_rank[..n].par_iter().enumerate().with_min_len(4096).for_each(|(i, c)| {
        out[(cell_start[c.x as usize] + c.y) as usize].store(i as u32, Relaxed);
    });
}
