use glam::{Vec3, Vec4Swizzles};

use super::ShiftedIntegrateBindings;
use crate::passes::advance::{Before, Change, Persistent, advance_all};

pub(super) fn shifted_integrate<const COUNTS: bool>(buffers: ShiftedIntegrateBindings<'_>) {
    let ShiftedIntegrateBindings {
        params,
        grid,
        state,
        sorted_positions,
        sorted_velocities,
        shifts,
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
    advance_all((params, grid, state), before, persistent, COUNTS, |i, _| Change {
        acceleration: accelerations[i].xyz(),
        shift: if accelerations[i].w == 0.0 { shifts[i].xyz() } else { Vec3::ZERO },
        density: shifts[i].w,
    });
}
