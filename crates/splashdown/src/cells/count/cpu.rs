use std::sync::atomic::Ordering::Relaxed;

use glam::{Vec4, Vec4Swizzles};
use rayon::prelude::*;
use splashdown_gpu::as_atomic;

use super::CountBindings;
use crate::cells::cell_counts::{self, CellCounter};
use crate::state::{DEAD_ESCAPED, DEAD_NON_FINITE, StepCounters};

const CHUNK: usize = 4096;

pub(super) fn count(buffers: CountBindings<'_>) {
    let CountBindings { params, grid, state, positions, velocities, cell_counts, counters } = buffers;
    let n = state.run_count as usize;
    let counters = as_atomic(counters);
    // After the last step of a frame no step follows that needs the count.
    let is_count_unused = counters[StepCounters::MOVED].load(Relaxed) != 0 && state.is_last_step();
    let (counts, cells) = cell_counts::split(grid, cell_counts);
    let classify = |p: &mut Vec4, v: Vec4| {
        let x = p.xyz();
        if p.w != 0.0 {
            return grid.cell_count;
        }
        if !x.is_finite() {
            *p = params.domain_min.extend(DEAD_NON_FINITE);
            counters[StepCounters::NON_FINITE].fetch_add(1, Relaxed);
        } else if !(v.xyz().length_squared() + v.w).is_finite() {
            p.w = DEAD_NON_FINITE;
            counters[StepCounters::NON_FINITE].fetch_add(1, Relaxed);
        } else if params.is_outside(x) {
            p.w = DEAD_ESCAPED;
            counters[StepCounters::ESCAPED].fetch_add(1, Relaxed);
        } else {
            return grid.cell_of(x);
        }
        grid.cell_count
    };
    let positions = positions[..n].par_chunks_mut(CHUNK);
    let velocities = velocities[..n].par_chunks(CHUNK);
    let cells = cells[..n].par_chunks_mut(CHUNK);
    positions.zip(velocities).zip(cells).for_each(|((positions, velocities), cells)| {
        let mut counter = CellCounter::new(counts);
        for ((p, &v), out) in positions.iter_mut().zip(velocities).zip(cells) {
            let cell = classify(p, v);
            if !is_count_unused {
                *out = cell;
                counter.add(cell);
            }
        }
    });
}
