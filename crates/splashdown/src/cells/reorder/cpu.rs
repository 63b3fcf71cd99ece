use glam::Vec4;
use rayon::prelude::*;
use splashdown_gpu::{CpuWork, Slot};

use crate::passes::StepState;

const CHUNK: usize = 4096;

pub(super) fn reorder(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [state, order, positions, velocities, ids, sorted_positions, sorted_velocities, sorted_ids] = slots
    else {
        unreachable!()
    };
    let n = state.get::<StepState>().run_count as usize;
    let order = &order.read::<u32>()[..n];
    let (positions, velocities, ids) =
        (positions.read::<Vec4>(), velocities.read::<Vec4>(), ids.read::<u32>());
    order
        .par_chunks(CHUNK)
        .zip(sorted_positions.write::<Vec4>().par_chunks_mut(CHUNK))
        .zip(sorted_velocities.write::<Vec4>().par_chunks_mut(CHUNK))
        .zip(sorted_ids.write::<u32>().par_chunks_mut(CHUNK))
        .for_each(|(((order, p), v), id)| {
            for (k, &i) in order.iter().enumerate() {
                let i = i as usize;
                (p[k], v[k], id[k]) = (positions[i], velocities[i], ids[i]);
            }
        });
}
