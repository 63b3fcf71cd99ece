use glam::Vec4Swizzles;

use super::ForceIntegrateBindings;
use crate::boundary::{Images, WallKernel, part};
use crate::kernel::Kernel;
use crate::pairs;
use crate::passes::acceleration::cpu::Acceleration;
use crate::passes::advance::{Before, Change, Persistent, advance_all};

/// Uses two sweeps: integrating a particle directly after its sums slows down the loop over the neighbours, and made
/// steps 3 to 10 % slower. The persistent velocities, which the second sweep writes, store the accelerations in between.
pub(super) fn force_integrate<K: Kernel + WallKernel>(buffers: ForceIntegrateBindings<'_>) {
    let ForceIntegrateBindings {
        params,
        grid,
        state,
        cell_start,
        sorted_positions,
        sorted_velocities,
        densities,
        positions,
        velocities,
        counters,
        cell_counts,
    } = buffers;
    if state.done != 0 {
        return;
    }
    let before = Before { positions: sorted_positions, velocities: sorted_velocities };
    let persistent = Persistent { positions, velocities, counters, cell_counts };
    let Before { positions, velocities } = before;
    let forces = Acceleration::<K, { part::ALL }>::new(params, state, positions, velocities, densities);
    let places = pairs::Sorted::new(params.support_radius, grid, cell_start, positions)
        .with_images(Images::new(params));
    pairs::for_each(places, &mut *persistent.velocities, &forces);
    advance_all((params, grid, state), before, persistent, true, |i, a| {
        Change::unshifted(a.xyz(), densities[i].x)
    });
}
