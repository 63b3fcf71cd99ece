//! The CPU code: each task compacts a range of flags into its part of the list.

use rayon::prelude::*;

use super::{CompactParams, GatherBindings};
use crate::dispatch_groups;

/// Flags per task.
const TASK: usize = 16_384;

pub(super) fn gather(GatherBindings { params, starts, indices, counted }: GatherBindings<'_>) {
    let CompactParams { len, workgroup_size } = *params;
    let starts = &starts[..=len as usize];
    let count = starts[len as usize];
    let fitting = count.min(indices.len() as u32);
    let [x, y, z] = dispatch_groups(fitting.div_ceil(workgroup_size));
    counted[..4].copy_from_slice(&[x, y, z, count]);

    let mut rest = &mut indices[..fitting as usize];
    let mut tasks = Vec::with_capacity(len as usize / TASK + 1);
    for first in (0..len as usize).step_by(TASK) {
        let end = (first + TASK).min(len as usize);
        let kept = (starts[end].min(fitting) - starts[first].min(fitting)) as usize;
        let (part, after) = rest.split_at_mut(kept);
        rest = after;
        tasks.push((first, &starts[first..=end], part));
    }
    tasks.into_par_iter().for_each(|(first, starts, part)| {
        // Every index is written to the next free position, which only a set flag advances. This avoids a mispredicted
        // branch.
        let mut kept = 0;
        for (i, pair) in starts.windows(2).enumerate() {
            if let Some(place) = part.get_mut(kept) {
                *place = (first + i) as u32;
            }
            kept += usize::from(pair[0] != pair[1]);
        }
    });
}
