use glam::Vec4Swizzles;
use rayon::prelude::*;

use super::FinishBindings;

/// Particles per task.
const CHUNK: usize = 4096;

pub(super) fn finish(buffers: FinishBindings<'_>) {
    let FinishBindings {
        grid,
        state,
        viscous,
        cell_start,
        sorted_velocities: velocities,
        viscous_residuals: residuals,
        predicted,
        iterates,
        accelerations,
    } = buffers;
    let n = cell_start[grid.cell_count as usize].min(state.run_count) as usize;
    accelerations[..n].par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, accelerations)| {
        for (k, a) in accelerations.iter_mut().enumerate() {
            let i = chunk * CHUNK + k;
            let pressure = iterates[i].yzw();
            if a.w == 1.0 {
                continue;
            }
            let before = velocities[i].xyz();
            let solution = if viscous.updates == 0 { before } else { predicted[i].xyz() };
            let u = solution + residuals[i].xyz();
            *a = ((u - before) / state.dt - pressure).extend(a.w);
        }
    });
}
