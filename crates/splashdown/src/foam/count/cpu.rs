use glam::Vec4;
use rayon::prelude::*;
use splashdown_gpu::{CpuWork, Slot};

use crate::cells::Grid;
use crate::foam::types::{seed_of, unit};
use crate::foam::{FoamParams, FoamState};

pub(super) fn count(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [grid, foam, foam_state, cell_start, sorted_ids, potentials, counts] = slots else { unreachable!() };
    let (foam, now) = (foam.get::<FoamParams>(), foam_state.get::<FoamState>());
    if now.is_due == 0 {
        return;
    }
    let living = cell_start.read::<u32>()[grid.get::<Grid>().cell_count as usize] as usize;
    let (ids, potentials) = (sorted_ids.read::<u32>(), potentials.read::<Vec4>());
    counts.write::<u32>()[..living].par_iter_mut().with_min_len(4096).enumerate().for_each(|(i, count)| {
        *count = (foam.expected(potentials[i], now.dt) + unit(seed_of(ids[i], now.step))) as u32;
    });
}
