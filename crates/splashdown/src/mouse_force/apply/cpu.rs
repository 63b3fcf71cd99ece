use glam::{Vec4, Vec4Swizzles};
use rayon::prelude::*;
use splashdown_gpu::{CpuWork, Slot};

use crate::cells::Grid;
use crate::mouse_force::MouseForce;
use crate::state::StepState;

pub(super) fn apply(_: CpuWork, slots: &mut [Slot<'_>]) {
    let [grid, state, cell_start, mouse_force, sorted_positions, sorted_velocities, accelerations] = slots
    else {
        unreachable!()
    };
    let mouse_force = mouse_force.get::<MouseForce>();
    if mouse_force.rate == 0.0 {
        return;
    }
    let living = cell_start.read::<u32>()[grid.get::<Grid>().cell_count as usize];
    let n = living.min(state.get::<StepState>().run_count) as usize;
    let (positions, velocities) = (sorted_positions.read::<Vec4>(), sorted_velocities.read::<Vec4>());
    accelerations.write::<Vec4>()[..n].par_iter_mut().with_min_len(4096).enumerate().for_each(|(i, a)| {
        *a += mouse_force.acceleration(positions[i].xyz(), velocities[i].xyz()).extend(0.0);
    });
}
