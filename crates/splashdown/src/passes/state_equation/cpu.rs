use glam::Vec2;
use rayon::prelude::*;

use super::StateEquationBindings;

pub(super) fn state_equation(buffers: StateEquationBindings<'_>) {
    let StateEquationBindings { params, state, sorted_velocities: velocities, densities } = buffers;
    let n = state.run_count as usize;
    let velocities = velocities[..n].par_iter().with_min_len(4096);
    densities[..n].par_iter_mut().zip(velocities).for_each(|(density, v)| {
        *density = Vec2::new(v.w, params.pressure_at(v.w));
    });
}
