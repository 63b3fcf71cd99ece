use glam::Vec4Swizzles;
use rayon::prelude::*;

use super::ApplyBindings;

pub(super) fn apply(buffers: ApplyBindings<'_>) {
    let ApplyBindings {
        grid,
        state,
        cell_start,
        mouse_force,
        sorted_positions,
        sorted_velocities,
        accelerations,
    } = buffers;
    if mouse_force.rate == 0.0 {
        return;
    }
    let active = cell_start[grid.cell_count as usize];
    let n = active.min(state.run_count) as usize;
    let (positions, velocities) = (sorted_positions, sorted_velocities);
    accelerations[..n].par_iter_mut().with_min_len(4096).enumerate().for_each(|(i, a)| {
        *a += mouse_force.acceleration(positions[i].xyz(), velocities[i].xyz()).extend(0.0);
    });
}
