use glam::Vec4Swizzles;

use super::IntegrateBindings;
use crate::passes::advance::{Before, Change, Persistent, advance_all};

pub(super) fn integrate<const COUNTS: bool>(buffers: IntegrateBindings<'_>) {
    let IntegrateBindings {
        params,
        grid,
        state,
        sorted_positions,
        sorted_velocities,
        densities,
        accelerations,
        positions,
        velocities,
        counters,
        cell_counts,
    } = buffers;
    if state.done != 0 {
        return;
    }
    let before = Before { positions: sorted_positions, velocities: sorted_velocities };
    let persistent = Persistent { positions, velocities, counters, cell_counts };
    let constants = (params, grid, state);
    advance_all(constants, before, persistent, COUNTS, |i, _| {
        Change::unshifted(accelerations[i].xyz(), densities[i].x)
    });
}
