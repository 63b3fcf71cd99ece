use glam::Vec4Swizzles;
use rayon::prelude::*;

use super::InflowConstraintBindings;
use crate::flow::{EmissionSchedule, Nozzle};

pub(super) fn inflow_constraint(buffers: InflowConstraintBindings<'_>) {
    let InflowConstraintBindings {
        params,
        grid,
        state,
        cell_start,
        nozzles,
        schedules,
        sorted_positions,
        sorted_velocities,
        accelerations,
    } = buffers;
    let active = cell_start[grid.cell_count as usize];
    let n = active.min(state.run_count) as usize;
    let on: Vec<Nozzle> = nozzles
        .iter()
        .zip(schedules.chunks_exact(EmissionSchedule::WORDS))
        .filter(|(nozzle, schedule)| {
            state.time >= nozzle.start
                && state.time < nozzle.end
                && schedule[EmissionSchedule::EMITTED] + nozzle.points <= nozzle.most
        })
        .map(|(nozzle, _)| *nozzle)
        .collect();
    if on.is_empty() {
        return;
    }
    let (positions, velocities) = (sorted_positions, sorted_velocities);
    accelerations[..n].par_iter_mut().with_min_len(4096).enumerate().for_each(|(i, a)| {
        let x = positions[i].xyz();
        if let Some(nozzle) = on.iter().find(|nozzle| nozzle.holds(x, params.particle_spacing)) {
            let change = nozzle.speed * nozzle.direction - velocities[i].xyz();
            *a = (change / state.dt).extend(1.0);
        }
    });
}
