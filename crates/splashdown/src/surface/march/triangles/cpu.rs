use glam::UVec2;
use rayon::prelude::*;

use super::super::halo;
use super::TrianglesBindings;
use crate::marching_cubes;
use crate::surface::params::NONE;
use crate::surface::parts::by_starts;

pub(super) fn triangles(buffers: TrianglesBindings<'_>) {
    let TrianglesBindings { lattice, status, block_list, block_slot, rows, vertex_starts, .. } = buffers;
    let triangles = buffers.indices.as_chunks_mut::<3>().0;
    let outputs = by_starts(triangles, &buffers.triangle_starts[..=status.blocks as usize]);
    let outputs: Vec<_> =
        outputs.into_iter().enumerate().filter(|(_, triangles)| !triangles.is_empty()).collect();
    outputs.into_par_iter().for_each(|(slot, triangles)| {
        let slots = halo::upper_slots(lattice, block_slot, lattice.block_place(block_list[slot]));
        let signs = halo::signs(&slots, |row| rows[row].x >> 24);
        let vertices = Vertices { slots, rows, starts: vertex_starts };
        let mut triangles = triangles.iter_mut();
        for cell in 0..512 {
            let (x, y, z) = (cell & 7, cell >> 3 & 7, cell >> 6);
            for edges in &marching_cubes::TRIANGLES[halo::cell_case(&signs, x, y, z)] {
                let corners = edges.map(|edge| vertices.number([x, y, z], edge));
                // The capacity is too small: the remaining triangles are omitted, which the status
                // reports.
                let Some(triangle) = triangles.next() else { return };
                let has_room = corners.iter().all(|&corner| corner < lattice.vertex_capacity);
                *triangle = if has_room { corners } else { [0; 3] };
            }
        }
    });
}

struct Vertices<'a> {
    slots: [u32; 8],
    rows: &'a [UVec2],
    starts: &'a [u32],
}

impl Vertices<'_> {
    /// The index of the vertex on an edge of a cell.
    fn number(&self, cell: [usize; 3], edge: u8) -> u32 {
        let axis = usize::from(edge / 4);
        let (a, b) = (usize::from(edge & 1), usize::from(edge >> 1 & 1));
        let offset = [[0, a, b], [a, 0, b], [a, b, 0]][axis];
        let [x, y, z] = std::array::from_fn(|i| cell[i] + offset[i]);
        let slot = self.slots[(x >> 3) + 2 * (y >> 3) + 4 * (z >> 3)];
        if slot == NONE {
            return NONE;
        }
        let row = self.rows[slot as usize * 64 + (z & 7) * 8 + (y & 7)];
        let below = row.x & ((1 << (8 * axis + (x & 7))) - 1);
        self.starts[slot as usize] + (row.y & 0xffff) + below.count_ones()
    }
}
