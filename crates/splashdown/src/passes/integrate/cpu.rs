use glam::{Vec4, Vec4Swizzles};
use splashdown_gpu::{CpuWork, Slot};

use crate::passes::advance::{Before, Persistent, advance_all};
use crate::state::StepState;

pub(super) fn integrate<const COUNTS: bool>(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [
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
    ] = slots
    else {
        unreachable!()
    };
    let state = state.get::<StepState>();
    if state.done != 0 {
        return;
    }
    let before = Before {
        positions: sorted_positions.read(),
        velocities: sorted_velocities.read(),
        densities: densities.read(),
    };
    let persistent = Persistent {
        positions: positions.write(),
        velocities: velocities.write(),
        counters: counters.write(),
        cell_counts: cell_counts.write(),
    };
    let accelerations = accelerations.read::<Vec4>();
    let constants = (&params.get(), &grid.get(), &state);
    advance_all(constants, before, persistent, COUNTS, |i, _| accelerations[i].xyz());
}
