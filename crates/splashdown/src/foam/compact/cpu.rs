use rayon::prelude::*;

use super::CompactBindings;

pub(super) fn compact(buffers: CompactBindings<'_>) {
    let CompactBindings { foam_state, foam_indices: indices, foam_moved: moved, foam_pool: pool } = buffers;
    let now = *foam_state;
    if now.is_due == 0 {
        return;
    }
    let pool = pool[..now.kept as usize].par_iter_mut().with_min_len(4096);
    pool.zip(indices).for_each(|(place, &i)| *place = moved[i as usize]);
}
