//! Neighbour sums on the CPU, for solver, surface, foam and monitor.
//!
//! A pass supplies the formula of one pair. The engine visits the neighbours:
//!
//! * [`for_each`]: sums at every particle ([`PairSum`]);
//! * [`sums_at`]: sums at arbitrary points ([`PointSum`]);
//! * [`for_each_box`]: the particles near a box, for passes with their own inner loop
//!   ([`BoxPass`]);
//! * [`NeighbourLists`]: lists with a factor for each neighbour, for passes that repeat.
//!
//! # How it works
//! The particles' quantities are stored in columns, one array per quantity ([`Columns`]). The
//! neighbours of a cube of the grid lie in nine contiguous runs of particles. Those within reach of the
//! bounding box of the targets in the cube are packed into small columns once ([`Candidates`]): on
//! average 112 of 183 particles, at a support radius of two spacings. Every target then processes
//! the candidates in whole registers without a branch: particles beyond the support contribute
//! zero, and the end is padded with particles far away. Long formulas ([`PairSum::IS_LONG`]) and lists
//! first pack those candidates that are neighbours of the target, about 30.
//!
//! Sums are accumulated in a fixed number of lanes, and the candidates of a target depend only on
//! the targets in its cube. Results are therefore bit-identical for any number of threads and any
//! width of the registers.
//!
//! # Why not the other way
//! * A list of neighbours per particle for passes that visit them once: to make it costs more than the visit (measured,
//!   `docs/performance.md`). Iterations over the same neighbours use [`NeighbourLists`].
//! * Visiting each pair once: the sums would depend on the order of the threads.

mod boxes;
mod candidates;
mod columns;
mod lists;
mod near;
mod particles;
mod points;
#[cfg(test)]
mod tests;
mod vector;
mod vectors;

use std::ops::Range;

use glam::{Vec3, Vec4};

use crate::boundary::Images;
use crate::cells::Grid;
pub(crate) use boxes::{BoxPass, for_each_box};
pub(crate) use lists::{ListedPair, ListedSum, NeighbourLists, Radial};
pub(crate) use near::{Differences, Link, NearImages, Projections, Values};
pub(crate) use particles::{Added, Outputs, PairSum, for_each};
pub(crate) use points::{PointSum, sums_at};
pub(crate) use vector::{
    difference, dot, extrapolated, reflected, reflected_matrix, reflected_point, scaled, splat,
};

/// Particles sorted by cell.
#[derive(Clone, Copy)]
pub(crate) struct Sorted<'a> {
    pub grid: &'a Grid,
    /// First particle of each cell, followed by the number of active particles: see
    /// [`Cells::cell_start`](crate::cells::Cells::cell_start).
    pub cell_start: &'a [u32],
    /// Positions in metres, sorted by cell; w is ignored.
    pub positions: &'a [Vec4],
    /// Radius within which particles are neighbours, in metres; at most the size of a cube.
    pub support_radius: f32,
    /// Closed sides behind which the particles have images.
    pub images: Images,
}

impl<'a> Sorted<'a> {
    pub fn new(support_radius: f32, grid: &'a Grid, cell_start: &'a [u32], positions: &'a [Vec4]) -> Self {
        Self { grid, cell_start, positions, support_radius, images: Images::NONE }
    }

    /// The same particles with their images behind closed sides. [`for_each`] and [`for_each_box`] visit images; boxes
    /// lie in front of the sides.
    pub fn with_images(self, images: Images) -> Self {
        Self { images, ..self }
    }

    /// Number of active particles.
    pub fn active_count(&self) -> usize {
        self.cell_start[self.grid.cell_count as usize] as usize
    }

    /// The particles of a number of consecutive cells along x.
    #[inline(always)]
    fn run(&self, first_cell: usize, cells: usize) -> Range<usize> {
        self.cell_start[first_cell] as usize..self.cell_start[first_cell + cells] as usize
    }

    /// The particles of all cells that intersect a box, one run per row of cells.
    #[inline(always)]
    pub fn rows_near(&self, [low, high]: [Vec3; 2]) -> impl Iterator<Item = Range<usize>> + Clone + 'a {
        let (sorted, grid) = (*self, self.grid);
        let size = grid.size();
        // Casts to integers saturate, so that cells outside the grid become its border cells.
        let cell = |x: Vec3| grid.coordinates(x).to_array().map(|x| x.floor() as u32);
        let (first, last) = (cell(low), cell(high));
        let [x, y, z] = std::array::from_fn(|axis| {
            let end = last[axis].min(size[axis] - 1) as usize + 1;
            (first[axis] as usize).min(end)..end
        });
        z.flat_map(move |z| y.clone().map(move |y| z * size[1] as usize + y)).map(move |row| {
            let first = row * size[0] as usize + x.start;
            sorted.run(first, x.len())
        })
    }

    /// The particles of the cube that begins with this cell.
    #[inline(always)]
    pub fn cube(&self, cube: usize) -> Range<usize> {
        self.run(cube, self.grid.slices as usize)
    }

    /// The particles of the cube that begins with this cell and of its 26 neighbours: nine rows of three cubes each.
    #[inline(always)]
    pub fn runs_around(&self, cube: usize) -> [Range<usize>; 9] {
        self.grid.runs_around(self.cell_start, cube as u32)
    }

    /// As [`runs_around`](Self::runs_around), for the cube of a point.
    #[inline(always)]
    pub fn runs_around_point(&self, x: Vec3) -> [Range<usize>; 9] {
        self.grid.runs_around(self.cell_start, self.grid.cube_of(x))
    }
}
