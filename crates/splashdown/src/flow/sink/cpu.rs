use glam::Vec4Swizzles;
use rayon::prelude::*;

use super::SinkBindings;
use crate::state::{DEAD_DRAINED, StepCounters};

pub(super) fn sink(buffers: SinkBindings<'_>) {
    let SinkBindings { grid, state, cell_start, drains, drain_maps, sorted_positions, counters } = buffers;
    let active = cell_start[grid.cell_count as usize];
    let n = active.min(state.run_count) as usize;
    let maps = drain_maps;
    let positions = sorted_positions[..n].par_iter_mut().with_min_len(4096);
    let drained = positions
        .filter_map(|p| {
            let is_drained = p.w == 0.0 && drains.iter().any(|drain| drain.takes(maps, p.xyz()));
            is_drained.then(|| p.w = DEAD_DRAINED)
        })
        .count();
    counters[StepCounters::DRAINED] += drained as u32;
}
