//! The nodes of a block for the passes that write the field on the CPU.

use glam::Vec3;

use crate::surface::Walls;
use crate::surface::params::{Lattice, NODES, ROWS, SIDE};

pub(in crate::surface) const N: usize = SIDE as usize;
/// Nodes of a layer of a block.
pub(in crate::surface) const LAYER: usize = N * N;

/// The nodes of the marked blocks.
#[derive(Clone, Copy)]
pub(in crate::surface) struct Nodes<'a> {
    pub lattice: &'a Lattice,
    /// The list of blocks.
    pub blocks: &'a [u32],
}

impl Nodes<'_> {
    /// The coordinates of the nodes of a block along each axis.
    fn axes(&self, i: usize) -> [[f32; N]; 3] {
        let first = self.lattice.block_place(self.blocks[i]).map(|place| place as u32 * SIDE);
        std::array::from_fn(|axis| {
            std::array::from_fn(|n| self.lattice.coordinate(axis, first[axis] + n as u32))
        })
    }

    /// The coordinates in front of the walls at which the field has the same values as at the nodes of a block.
    pub fn folded_axes(&self, i: usize) -> [[f32; N]; 3] {
        let (low, high) = (self.lattice.wall_low, self.lattice.wall_high);
        let mut axes = self.axes(i);
        for (axis, coordinates) in axes.iter_mut().enumerate() {
            for coordinate in coordinates {
                *coordinate = Walls::folded(low[axis], high[axis], *coordinate);
            }
        }
        axes
    }

    /// The corners of the box around the folded nodes of a block.
    pub fn corners(&self, i: usize) -> [Vec3; 2] {
        let ends = self.folded_axes(i).map(ends);
        [ends.map(|end| end[0]), ends.map(|end| end[1])].map(Vec3::from)
    }

    /// Which nodes of an axis are in front of the walls, one bit each.
    fn in_front(&self, axis: usize, coordinates: &[f32; N]) -> u32 {
        let Lattice { wall_low, wall_high, wall_margin, .. } = self.lattice;
        let is_in_front = |x: f32| (x - wall_low[axis]).min(wall_high[axis] - x) > *wall_margin;
        (0..N).fold(0, |bits, n| bits | u32::from(is_in_front(coordinates[n])) << n)
    }

    /// The signs of the rows of a block, from the values at its nodes.
    pub fn set_signs(&self, i: usize, values: &[f32; NODES], signs: &mut [u32; ROWS]) {
        let axes = self.axes(i);
        let in_front: [u32; 3] = std::array::from_fn(|axis| self.in_front(axis, &axes[axis]));
        for (number, (signs, row)) in signs.iter_mut().zip(values.as_chunks::<N>().0).enumerate() {
            let is_in_front = in_front[1] >> (number % N) & in_front[2] >> (number / N) & 1 == 1;
            let inside = (0..N).fold(0, |bits, n| bits | (u32::from(row[n] >= self.lattice.iso_level) << n));
            *signs = if is_in_front { inside & in_front[0] } else { 0 };
        }
    }
}

/// The lowest and the highest of the coordinates, which folding leaves in any order.
pub(super) fn ends(coordinates: [f32; N]) -> [f32; 2] {
    [coordinates.into_iter().fold(f32::MAX, f32::min), coordinates.into_iter().fold(f32::MIN, f32::max)]
}
