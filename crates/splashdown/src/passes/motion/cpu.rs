use glam::{Vec4, Vec4Swizzles};
use splashdown_gpu::{CpuWork, Slot};

use crate::boundary::WallKernel;
use crate::cells::Grid;
use crate::kernel::Kernel;
use crate::passes::momentum::cpu::Momentum;
use crate::passes::moving::{Before, Resting, advance_all};
use crate::passes::{Params, StepState, pairs};

/// Two sweeps: moving a particle right behind its sums crowds the loop over the neighbours, and took 3 to 10 %
/// of a step longer. The resting velocities, which the second sweep writes, hold the accelerations in between.
pub(super) fn motion<K: Kernel + WallKernel>(_: CpuWork, slots: &mut [Slot<'_>]) {
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
        tally,
        census,
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
    let resting = Resting {
        positions: positions.write(),
        velocities: velocities.write::<Vec4>(),
        tally: tally.write(),
        census: census.write(),
    };
    let Before { positions, velocities, densities } = before;
    let forces = Momentum::<K>::new(params, state, positions, velocities, densities, wall_table.read());
    let places = pairs::Sorted::new(params, grid, cell_start.read(), positions);
    pairs::for_each(places, resting.velocities, &forces);
    advance_all((params, grid, state), before, resting, true, |_, a| a.xyz());
}
