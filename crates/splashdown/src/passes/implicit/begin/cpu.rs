use glam::{Vec4, Vec4Swizzles};
use rayon::prelude::*;

use super::BeginBindings;
use crate::state::{SolveState, StepState};

/// Particles per task.
const CHUNK: usize = 4096;

pub(super) fn begin(buffers: BeginBindings<'_>) {
    let BeginBindings {
        params,
        grid,
        state,
        cell_start,
        sorted_velocities: velocities,
        sorted_pressures: pressures,
        accelerations,
        densities,
        solve,
        iterates,
        free_velocities,
    } = buffers;
    if state.done != StepState::SUSPENDED {
        let longest = params.longest_step(state.max_speed.max(state.body_speed), 0.0, 0.0);
        let dt_ratio = (state.dt / longest).min(1.0);
        *solve = SolveState::new(state.run_count == 0, params.relaxation, dt_ratio);
    }
    let active = cell_start[grid.cell_count as usize] as usize;
    let chunks =
        iterates[..active].par_chunks_mut(CHUNK).zip(free_velocities[..active].par_chunks_mut(CHUNK));
    chunks.enumerate().for_each(|(chunk, (iterates, free_velocities))| {
        for (k, (iterate, free)) in iterates.iter_mut().zip(free_velocities).enumerate() {
            let i = chunk * CHUNK + k;
            let excess = densities[i].x / params.rest_density - 1.0;
            *iterate = Vec4::new(pressures[i], 0.0, 0.0, excess);
            let other = accelerations[i];
            *free = (velocities[i].xyz() + state.dt * other.xyz()).extend(other.w);
        }
    });
}
