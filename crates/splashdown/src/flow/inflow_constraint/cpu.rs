use std::sync::atomic::{AtomicU32, Ordering};

use glam::Vec4Swizzles;
use rayon::prelude::*;
use splashdown_gpu::as_atomic;

use super::InflowConstraintBindings;
use crate::flow::{EmissionSchedule, Nozzle};

/// A nozzle that emits.
struct Active<'a> {
    nozzle: &'a Nozzle,
    /// Particles beside it in the step before.
    beside: u32,
    counted: &'a AtomicU32,
}

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
    let nozzles: Vec<Active<'_>> = nozzles
        .iter()
        .zip(as_atomic(schedules).chunks_exact(EmissionSchedule::WORDS))
        .filter_map(|(nozzle, schedule)| {
            let word = |word: usize| schedule[word].load(Ordering::Relaxed);
            let is_on = state.time >= nozzle.start
                && state.time < nozzle.end
                && word(EmissionSchedule::EMITTED) + nozzle.points <= nozzle.most;
            let counted = &schedule[EmissionSchedule::COUNTED];
            is_on.then(|| Active { nozzle, beside: word(EmissionSchedule::BESIDE), counted })
        })
        .collect();
    if nozzles.is_empty() {
        return;
    }
    let (positions, velocities) = (sorted_positions, sorted_velocities);
    accelerations[..n].par_iter_mut().with_min_len(4096).enumerate().for_each(|(i, a)| {
        let x = positions[i].xyz();
        for on in nozzles.iter().filter(|on| on.nozzle.is_beside(x)) {
            on.counted.fetch_add(1, Ordering::Relaxed);
        }
        if let Some(on) = nozzles.iter().find(|on| on.nozzle.holds(x, params.particle_spacing)) {
            let change = on.nozzle.velocity(x, state.dt, on.beside) - velocities[i].xyz();
            *a = (change / state.dt).extend(1.0);
        }
    });
}
