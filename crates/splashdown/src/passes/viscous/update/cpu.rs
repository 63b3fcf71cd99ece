use glam::Vec4Swizzles;
use rayon::prelude::*;

use super::UpdateBindings;

/// Particles per task.
const CHUNK: usize = 4096;

pub(super) fn update(buffers: UpdateBindings<'_>) {
    let UpdateBindings {
        grid,
        state,
        viscous,
        cell_start,
        sorted_velocities: velocities,
        viscous_products: products,
        viscous_residuals,
        viscous_directions,
        viscous_images,
        predicted,
    } = buffers;
    if viscous.stopped != 0 {
        return;
    }
    let n = cell_start[grid.cell_count as usize].min(state.run_count) as usize;
    let is_first = viscous.updates == 1;
    viscous_residuals[..n]
        .par_chunks_mut(CHUNK)
        .zip(viscous_directions[..n].par_chunks_mut(CHUNK))
        .zip(viscous_images[..n].par_chunks_mut(CHUNK))
        .zip(predicted[..n].par_chunks_mut(CHUNK))
        .enumerate()
        .for_each(|(chunk, (((residuals, directions), images), predicted))| {
            let first = chunk * CHUNK;
            for k in 0..residuals.len() {
                let r = residuals[k];
                let (mut p, mut s) = (r.w * r.xyz(), products[first + k].xyz());
                if viscous.beta != 0.0 {
                    p += viscous.beta * directions[k].xyz();
                    s += viscous.beta * images[k].xyz();
                }
                let before = if is_first { velocities[first + k].xyz() } else { predicted[k].xyz() };
                (directions[k], images[k]) = (p.extend(0.0), s.extend(0.0));
                predicted[k] = (before + viscous.alpha * p).extend(0.0);
                residuals[k] = (r.xyz() - viscous.alpha * s).extend(r.w);
            }
        });
}
