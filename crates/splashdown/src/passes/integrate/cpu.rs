use glam::{Vec2, Vec4, Vec4Swizzles};
use rayon::prelude::*;
use splashdown_gpu::{CpuWork, Slot};

use crate::cells::Grid;
use crate::cells::census::{self, Enroller};
use crate::passes::moving::{Found, advance};
use crate::passes::{Params, StepState};

const CHUNK: usize = 4096;

pub(super) fn integrate<const COUNTS: bool>(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [
        params,
        grid,
        state,
        sorted_positions,
        sorted_velocities,
        densities,
        accelerations,
        positions,
        velocities,
        tally,
        census,
    ] = slots
    else {
        unreachable!()
    };
    let (params, grid, state) = (&params.get::<Params>(), &grid.get::<Grid>(), state.get::<StepState>());
    if state.done != 0 {
        return;
    }
    let n = state.run_count as usize;
    let counting = COUNTS && !state.is_last_step();
    let (counts, cells) = census::split(grid, census.write());
    let found: Vec<Found> = sorted_positions.read::<Vec4>()[..n]
        .par_chunks(CHUNK)
        .zip(sorted_velocities.read::<Vec4>()[..n].par_chunks(CHUNK))
        .zip(densities.read::<Vec2>()[..n].par_chunks(CHUNK))
        .zip(accelerations.read::<Vec4>()[..n].par_chunks(CHUNK))
        .zip(positions.write::<Vec4>()[..n].par_chunks_mut(CHUNK))
        .zip(velocities.write::<Vec4>()[..n].par_chunks_mut(CHUNK))
        .zip(cells[..n].par_chunks_mut(CHUNK))
        .map(|((((((p, v), density), a), new_p), new_v), cells)| {
            let mut found = Found::default();
            let mut enroller = Enroller::new(counts);
            for k in 0..p.len() {
                let particle = (p[k], v[k], density[k].x, a[k].xyz());
                let moved = advance(params, grid, state.dt, particle, &mut found);
                (new_p[k], new_v[k]) = (moved.position, moved.velocity);
                if counting {
                    cells[k] = moved.cell;
                    enroller.add(moved.cell);
                }
            }
            found
        })
        .collect();
    Found::tell(&found, tally.write());
}
