use glam::Vec4Swizzles;

use super::SeparateBindings;
use crate::surface::droplets::Droplet;

/// Serial: it copies 16 bytes per particle, which is limited by the memory.
pub(super) fn separate(buffers: SeparateBindings<'_>) {
    let SeparateBindings {
        lattice,
        grid,
        cell_start,
        sorted_positions,
        sorted_velocities,
        sorted_ids,
        kept,
        kept_starts,
        kept_positions,
        droplets,
    } = buffers;
    let active = cell_start[grid.cell_count as usize].min(lattice.particle_capacity) as usize;
    for i in 0..active {
        let start = kept_starts[i] as usize;
        if kept[i] != 0 {
            kept_positions[start] = sorted_positions[i];
        } else {
            droplets[i - start] = Droplet {
                position: sorted_positions[i].xyz(),
                id: sorted_ids[i],
                velocity: sorted_velocities[i].xyz(),
                padding: 0,
            };
        }
    }
}
