use glam::{Vec4, Vec4Swizzles};
use splashdown_gpu::{CpuWork, Slot};

use crate::boundary::{WallKernel, part};
use crate::cells::Grid;
use crate::kernel::Kernel;
use crate::passes::acceleration::cpu::Acceleration;
use crate::passes::advance::{Before, Persistent, advance_all};
use crate::passes::pairs;
use crate::state::{Params, StepState};

/// Two sweeps: moving a particle right behind its sums crowds the loop over the neighbours, and took 3 to 10 %
/// of a step longer. The persistent velocities, which the second sweep writes, hold the accelerations in between.
pub(super) fn force_integrate<K: Kernel + WallKernel>(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [
        params,
        grid,
        state,
        wall_table,
        cell_start,
        sorted_positions,
        sorted_velocities,
        densities,
        positions,
        velocities,
        counters,
        cell_counts,
    ] = slots
    else {
        unreachable!()
    };
    let (params, grid, state) = (&params.get::<Params>(), &grid.get::<Grid>(), &state.get::<StepState>());
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
        velocities: velocities.write::<Vec4>(),
        counters: counters.write(),
        cell_counts: cell_counts.write(),
    };
    let Before { positions, velocities, densities } = before;
    let forces = Acceleration::<K, { part::ALL }>::new(
        params,
        state,
        positions,
        velocities,
        densities,
        wall_table.read(),
    );
    let places = pairs::Sorted::new(params, grid, cell_start.read(), positions);
    pairs::for_each(places, persistent.velocities, &forces);
    advance_all((params, grid, state), before, persistent, true, |_, a| a.xyz());
}
