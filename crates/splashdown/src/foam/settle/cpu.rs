use rayon::prelude::*;
use splashdown_gpu::{CpuWork, Slot};

use crate::foam::{Diffuse, FoamState};

pub(super) fn settle(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [foam_state, indices, moved, pool] = slots else { unreachable!() };
    let now = foam_state.get::<FoamState>();
    if now.is_due == 0 {
        return;
    }
    let (indices, moved) = (indices.read::<u32>(), moved.read::<Diffuse>());
    let pool = pool.write::<Diffuse>()[..now.kept as usize].par_iter_mut().with_min_len(4096);
    pool.zip(indices).for_each(|(place, &i)| *place = moved[i as usize]);
}
