use rayon::prelude::*;

use super::CountBindings;
use crate::foam::types::{seed_of, unit};

pub(super) fn count(buffers: CountBindings<'_>) {
    let CountBindings {
        grid,
        foam,
        foam_state,
        cell_start,
        sorted_ids,
        foam_potentials: potentials,
        foam_counts: counts,
    } = buffers;
    let now = foam_state;
    if now.is_due == 0 {
        return;
    }
    let active = cell_start[grid.cell_count as usize] as usize;
    let ids = sorted_ids;
    counts[..active].par_iter_mut().with_min_len(4096).enumerate().for_each(|(i, count)| {
        *count = (foam.expected(potentials[i], now.dt) + unit(seed_of(ids[i], now.step))) as u32;
    });
}
