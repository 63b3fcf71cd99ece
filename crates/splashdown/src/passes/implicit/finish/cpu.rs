use glam::Vec4Swizzles;
use rayon::prelude::*;

use super::FinishBindings;

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
    } = buffers;
    let active = (cell_start[grid.cell_count as usize].min(state.run_count)) as usize;
    pressures[active..state.run_count.max(active as u32) as usize].fill(0.0);
    accelerations[..active]
        .par_chunks_mut(CHUNK)
        .zip(densities[..active].par_chunks_mut(CHUNK))
        .zip(pressures[..active].par_chunks_mut(CHUNK))
        .zip(predicted[..active].par_chunks_mut(CHUNK))
        .enumerate()
        .for_each(|(chunk, (((accelerations, densities), pressures), predicted))| {
            for (k, a) in accelerations.iter_mut().enumerate() {
                let i = chunk * CHUNK + k;
                let before = velocities[i].xyz();
                let free = before + state.dt * a.xyz();
                let u = free + solve.scale * (predicted[k].xyz() - free);
                let pressure = solve.scale * predicted[k].w.max(0.0);
                let rho = densities[k].x;
                predicted[k] = ((u - free) / state.dt).extend(pressure);
                *a = ((u - before) / state.dt).extend(a.w);
                densities[k].y = params.pressure_factor * pressure * rho * rho / params.rest_density;
                let old = sorted_pressures[i].max(0.0);
                pressures[k] = solve.warm_start * (old + solve.renewal * (pressure - old));
            }
        });
}
