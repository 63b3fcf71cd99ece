use glam::{Vec4, Vec4Swizzles};
use rayon::prelude::*;

use super::ClassifyBindings;
use crate::pairs::Sorted;
use crate::surface::droplets::MAX_BLOB;

pub(super) fn classify(buffers: ClassifyBindings<'_>) {
    let ClassifyBindings { lattice, grid, cell_start, sorted_positions, kept } = buffers;
    let active = cell_start[grid.cell_count as usize].min(lattice.particle_capacity) as usize;
    let links = Links {
        sorted: Sorted::new(lattice.support_radius, grid, cell_start, sorted_positions),
        positions: sorted_positions,
        square: lattice.link_square,
    };
    let (min_blob, min_neighbours) = (lattice.min_blob as usize, lattice.min_neighbours as usize);
    kept[..active]
        .par_iter_mut()
        .enumerate()
        .with_min_len(256)
        .for_each(|(i, kept)| *kept = u32::from(!links.is_isolated(i, min_blob, min_neighbours)));
}

/// The links between particles that are sorted by cell.
pub(in crate::surface::droplets) struct Links<'a> {
    pub sorted: Sorted<'a>,
    pub positions: &'a [Vec4],
    /// Square of the largest distance of linked particles.
    pub square: f32,
}

impl Links<'_> {
    /// The particles that are linked to one, and itself.
    pub fn of(&self, i: usize) -> impl Iterator<Item = usize> {
        let x = self.positions[i].xyz();
        let mut runs = self.sorted.runs_around_point(x);
        // The row of the particle first: inside the fluid it is sufficient.
        runs.rotate_left(4);
        runs.into_iter().flatten().filter(move |&j| {
            let d = self.positions[j].xyz() - x;
            d.dot(d) < self.square
        })
    }

    /// Whether a particle is isolated, for a `min_blob` of at most [`MAX_BLOB`].
    pub fn is_isolated(&self, i: usize, min_blob: usize, min_neighbours: usize) -> bool {
        // The blob as far as it is known. The links of the first `next` members have been followed.
        let mut blob = [i as u32; MAX_BLOB as usize];
        let (mut count, mut next, mut neighbours) = (1, 0, 0);
        while next < count {
            for j in self.of(blob[next] as usize) {
                if blob[..count].contains(&(j as u32)) {
                    continue;
                }
                neighbours += usize::from(next == 0);
                if count < min_blob {
                    blob[count] = j as u32;
                    count += 1;
                }
                if count >= min_blob && neighbours >= min_neighbours {
                    return false;
                }
            }
            if neighbours < min_neighbours {
                return true;
            }
            next += 1;
        }
        count < min_blob
    }
}
