use glam::UVec2;
use rayon::prelude::*;

use super::super::halo;
use super::CountBindings;
use crate::marching_cubes::COUNTS;
use crate::surface::params::ROWS;

pub(super) fn count(buffers: CountBindings<'_>) {
    let CountBindings { lattice, status, block_list, block_slot, signs: sign_bits, rows, .. } = buffers;
    let counts = buffers.vertex_counts.par_iter_mut().zip(buffers.triangle_counts);
    let outputs = rows.par_chunks_exact_mut(ROWS).zip(counts);
    let blocks = block_list[..status.blocks as usize].par_iter().zip(outputs).with_min_len(16);
    blocks.for_each(|(&block, (rows, (vertex_count, triangle_count)))| {
        let slots = halo::upper_slots(lattice, block_slot, lattice.block_place(block));
        let signs = halo::signs(&slots, |row| sign_bits[row]);
        (*vertex_count, *triangle_count) = (0, 0);
        if halo::is_uniform(&signs) {
            rows.fill(UVec2::new(signs[0][0] << 24, 0));
            return;
        }
        for (row, out) in rows.iter_mut().enumerate() {
            let (y, z) = (row & 7, row >> 3);
            let here = signs[z][y];
            let x_edges = (here ^ here >> 1) & 255;
            let y_edges = (here ^ signs[z][y + 1]) & 255;
            let z_edges = (here ^ signs[z + 1][y]) & 255;
            let edges = x_edges | y_edges << 8 | z_edges << 16;
            *out = UVec2::new(edges | here << 24, *vertex_count | *triangle_count << 16);
            *vertex_count += edges.count_ones();
            // A row of cells whose four lines of nodes have equal signs has no triangles.
            let others = [signs[z][y + 1], signs[z + 1][y], signs[z + 1][y + 1]];
            if (here != 0 && here != 0x1ff) || others.iter().any(|&other| other != here) {
                *triangle_count +=
                    (0..8).map(|x| u32::from(COUNTS[halo::cell_case(&signs, x, y, z)])).sum::<u32>();
            }
        }
    });
}
