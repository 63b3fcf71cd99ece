use std::sync::atomic::Ordering::Relaxed;

use glam::{UVec2, Vec4, Vec4Swizzles};
use rayon::prelude::*;
use splashdown_gpu::{CpuWork, Slot};

use crate::cells::Grid;
use crate::passes::{DEAD_ESCAPED, DEAD_NON_FINITE, Params, StepState, Tally};

const CHUNK: usize = 4096;

pub(super) fn count(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [params, grid, state, positions, velocities, cell_rank, counts, tally] = slots else {
        unreachable!()
    };
    let (params, grid) = (params.get::<Params>(), grid.get::<Grid>());
    let n = state.get::<StepState>().run_count as usize;
    let (counts, tally) = (counts.atomics(), tally.atomics());
    let classify = |p: &mut Vec4, v: Vec4| {
        let x = p.xyz();
        if p.w != 0.0 {
            return grid.cell_count;
        }
        if !x.is_finite() {
            *p = params.domain_min.extend(DEAD_NON_FINITE);
            tally[Tally::NON_FINITE].fetch_add(1, Relaxed);
        } else if !(v.xyz().length_squared() + v.w).is_finite() {
            p.w = DEAD_NON_FINITE;
            tally[Tally::NON_FINITE].fetch_add(1, Relaxed);
        } else if x.cmplt(params.domain_min).any() || x.cmpgt(params.domain_max).any() {
            p.w = DEAD_ESCAPED;
            tally[Tally::ESCAPED].fetch_add(1, Relaxed);
        } else {
            return grid.cell_of(x);
        }
        grid.cell_count
    };
    let positions = positions.write::<Vec4>()[..n].par_chunks_mut(CHUNK);
    let cell_rank = cell_rank.write::<UVec2>()[..n].par_chunks_mut(CHUNK);
    let velocities = velocities.read::<Vec4>()[..n].par_chunks(CHUNK);
    positions.zip(velocities).zip(cell_rank).for_each(|((positions, velocities), cell_rank)| {
        for ((p, &v), out) in positions.iter_mut().zip(velocities).zip(cell_rank) {
            let cell = classify(p, v);
            *out = UVec2::new(cell, counts[cell as usize].fetch_add(1, Relaxed));
        }
    });
}
