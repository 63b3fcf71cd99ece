use std::sync::atomic::{AtomicU32, Ordering};

use glam::Vec4Swizzles;
use rayon::prelude::*;
use splashdown_gpu::as_atomic;

use super::InflowConstraintBindings;
use crate::flow::{EmissionSchedule, Nozzle};

/// A nozzle in this step.
struct Pipe<'a> {
    nozzle: &'a Nozzle,
    is_on: bool,
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
    let pipes: Vec<Pipe<'_>> = nozzles
        .iter()
        .zip(as_atomic(schedules).chunks_exact(EmissionSchedule::WORDS))
        .map(|(nozzle, schedule)| {
            let word = |word: usize| schedule[word].load(Ordering::Relaxed);
            let is_on = state.time >= nozzle.start
                && state.time < nozzle.end
                && word(EmissionSchedule::EMITTED) + nozzle.points <= nozzle.most;
            let counted = &schedule[EmissionSchedule::COUNTED];
            Pipe { nozzle, is_on, beside: word(EmissionSchedule::BESIDE), counted }
        })
        .collect();
    let (positions, velocities) = (sorted_positions, sorted_velocities);
    accelerations[..n].par_iter_mut().with_min_len(4096).enumerate().for_each(|(i, a)| {
        let x = positions[i].xyz();
        let holds = |pipe: &&Pipe<'_>| pipe.is_on && pipe.nozzle.holds(x, params.particle_spacing);
        if let Some(pipe) = pipes.iter().find(holds) {
            let velocity = pipe.nozzle.velocity(x, params.gravity, state.dt, pipe.beside);
            *a = ((velocity - velocities[i].xyz()) / state.dt).extend(1.0);
            return;
        }
        for pipe in pipes.iter().filter(|pipe| pipe.nozzle.is_beside(x, params.particle_spacing)) {
            pipe.counted.fetch_add(1, Ordering::Relaxed);
        }
    });
}
