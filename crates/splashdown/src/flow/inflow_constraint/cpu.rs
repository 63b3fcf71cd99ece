use glam::{Vec4, Vec4Swizzles};
use rayon::prelude::*;
use splashdown_gpu::{CpuWork, Slot};

use crate::cells::Grid;
use crate::flow::{EmissionSchedule, Nozzle};
use crate::state::{Params, StepState};

pub(super) fn inflow_constraint(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [
        params,
        grid,
        state,
        cell_start,
        nozzles,
        schedules,
        sorted_positions,
        sorted_velocities,
        accelerations,
    ] = slots
    else {
        unreachable!()
    };
    let (params, state) = (params.get::<Params>(), state.get::<StepState>());
    let living = cell_start.read::<u32>()[grid.get::<Grid>().cell_count as usize];
    let n = living.min(state.run_count) as usize;
    let on: Vec<Nozzle> = nozzles
        .read::<Nozzle>()
        .iter()
        .zip(schedules.read::<u32>().chunks_exact(EmissionSchedule::WORDS))
        .filter(|(nozzle, plan)| {
            state.time >= nozzle.start
                && state.time < nozzle.end
                && plan[EmissionSchedule::EMITTED] + nozzle.points <= nozzle.most
        })
        .map(|(nozzle, _)| *nozzle)
        .collect();
    if on.is_empty() {
        return;
    }
    let (positions, velocities) = (sorted_positions.read::<Vec4>(), sorted_velocities.read::<Vec4>());
    accelerations.write::<Vec4>()[..n].par_iter_mut().with_min_len(4096).enumerate().for_each(|(i, a)| {
        let x = positions[i].xyz();
        if let Some(nozzle) = on.iter().find(|nozzle| nozzle.holds(x, params.particle_spacing)) {
            let change = nozzle.speed * nozzle.direction - velocities[i].xyz();
            *a = (change / state.dt).extend(0.0);
        }
    });
}
