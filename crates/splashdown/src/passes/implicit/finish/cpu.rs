use glam::{Vec3, Vec4Swizzles};
use rayon::prelude::*;

use super::FinishBindings;
use crate::state::{SolveState, StepCounters};

/// Particles per task.
const CHUNK: usize = 4096;

pub(super) fn finish(buffers: FinishBindings<'_>) {
    let FinishBindings {
        params,
        grid,
        state,
        solve,
        cell_start,
        sorted_velocities: velocities,
        sorted_pressures,
        predicted,
        accelerations,
        densities,
        pressures,
        counters,
    } = buffers;
    let active = (cell_start[grid.cell_count as usize].min(state.run_count)) as usize;
    let solved_dt = state.dt / solve.advanced_part;
    let impulse_scale = solve.scale / solve.advanced_part;
    pressures[active..state.run_count.max(active as u32) as usize].fill(0.0);
    let largest = accelerations[..active]
        .par_chunks_mut(CHUNK)
        .zip(densities[..active].par_chunks_mut(CHUNK))
        .zip(pressures[..active].par_chunks_mut(CHUNK))
        .zip(predicted[..active].par_chunks_mut(CHUNK))
        .enumerate()
        .map(|(chunk, (((accelerations, densities), pressures), predicted))| {
            let mut largest = 0.0_f32;
            for (k, a) in accelerations.iter_mut().enumerate() {
                let i = chunk * CHUNK + k;
                let before = velocities[i].xyz();
                let solved = before + solved_dt * a.xyz();
                let accepted = predicted[k].w;
                let (free, change, pressure) = if accepted == SolveState::NO_PRESSURE {
                    (solved, Vec3::ZERO, 0.0)
                } else {
                    let free = before + state.dt * a.xyz();
                    (free, solve.scale * (predicted[k].xyz() - solved), impulse_scale * accepted)
                };
                let u = free + change;
                let rho = densities[k].x;
                predicted[k] = ((u - free) / state.dt).extend(pressure);
                *a = ((u - before) / state.dt).extend(a.w);
                densities[k].y = params.pressure_factor * pressure * rho * rho / params.rest_density;
                let old = sorted_pressures[i];
                let start = pressure * solve.advanced_part;
                pressures[k] = solve.warm_start * (old + solve.renewal * (start - old));
                largest = largest.max(old + solve.renewal.max(1.0 - solve.renewal) * (pressure - old));
            }
            largest
        })
        .reduce(|| 0.0, f32::max);
    counters[StepCounters::MAX_PRESSURE] = counters[StepCounters::MAX_PRESSURE].max(largest.to_bits());
}
