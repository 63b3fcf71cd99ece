use std::sync::atomic::Ordering;

use glam::{UVec3, Vec3};
use rayon::prelude::*;
use splashdown_gpu::as_atomic;

use super::MarkBindings;
use crate::surface::params::SIDE;

pub(super) fn mark(buffers: MarkBindings<'_>) {
    let MarkBindings { lattice, grid, cell_start, samples, marks } = buffers;
    let active = cell_start[grid.cell_count as usize].min(lattice.particle_capacity) as usize;
    let blocks = UVec3::new(lattice.blocks_x, lattice.blocks_y, lattice.blocks_z);
    let most = (blocks * SIDE - 1).as_vec3();
    let marks = as_atomic(marks);
    samples[..active].par_iter().with_min_len(1024).for_each(|position| {
        let p = position.truncate() - lattice.origin;
        let low = ((p - lattice.reach) * lattice.inverse_cell).floor() - 1.0;
        let high = ((p + lattice.reach) * lattice.inverse_cell).floor();
        let first = low.clamp(Vec3::ZERO, most).as_uvec3() / SIDE;
        let last = high.clamp(Vec3::ZERO, most).as_uvec3() / SIDE;
        for z in first.z..=last.z {
            for y in first.y..=last.y {
                let row = (z as usize * blocks.y as usize + y as usize) * blocks.x as usize;
                for mark in &marks[row + first.x as usize..=row + last.x as usize] {
                    // Most blocks are already marked, and a load does not invalidate the cache
                    // lines of other cores.
                    if mark.load(Ordering::Relaxed) == 0 {
                        mark.store(1, Ordering::Relaxed);
                    }
                }
            }
        }
    });
}
