use glam::{Vec4, Vec4Swizzles};
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
    let tasks = iterates[..n].par_chunks_mut(CHUNK).zip(accelerations[..n].par_chunks_mut(CHUNK));
    tasks.enumerate().for_each(|(chunk, (iterates, accelerations))| {
        for (k, (iterate, a)) in iterates.iter_mut().zip(accelerations).enumerate() {
            let i = chunk * CHUNK + k;
            let pressure = iterate.yzw();
            *iterate = Vec4::new(iterate.x, 0.0, 0.0, 0.0);
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
