//! How the CPU visits neighbours: a pass gives the formula of one pair ([`PairSum`]), [`for_each`] does the rest.
//!
//! *How it works.* The particles' quantities are laid out in columns, one array per quantity ([`Columns`]). Around a
//! cell lie nine contiguous runs of particles; those of them that are within reach of the box round the cell's own
//! particles are packed into small columns once ([`Candidates`]), on average 112 of 183 at two spacings of support.
//! Then every particle of the cell takes these in whole registers without a branch: what is beyond the support
//! contributes zero, and the end is padded with particles far away.
//!
//! *Why not* a list of neighbours per particle: gathering its quantities by index costs more than the arithmetic that
//! it saves (measured: `docs/performance.md`). *Why not* each pair once: the sums would depend on the order of the
//! threads.

mod candidates;
mod columns;
#[cfg(test)]
mod tests;
mod vector;

use std::ops::Range;

use glam::Vec4;
use rayon::prelude::*;

use crate::cells::Grid;
use crate::simd::{Leaf, Register, Simd, run_with};
use crate::state::Params;
use candidates::{Candidates, Surroundings};
use columns::Columns;
pub(crate) use vector::{difference, dot, scaled, splat};

/// A pass that sums `S` quantities over the neighbours of every particle, itself included, from `F` columns, the first
/// three of which are the position.
///
/// Whatever takes registers must be `#[inline(always)]`.
pub(crate) trait PairSum<const F: usize, const S: usize>: Sync {
    /// What the pass writes per particle.
    type Output: Send;

    /// The columns' values of particle `j`; the last ones must make a pair's share zero where they are zero, or the
    /// kernel must, beyond its support.
    fn load(&self, j: usize) -> [f32; F];

    /// The shares of a register of neighbours in the sums of particle `i`.
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; F]) -> [V; S];

    /// Writes the result of particle `i` from its sums.
    fn finish(&self, i: usize, sums: [f32; S], out: &mut Self::Output);

    /// False if the particle's sums are not needed: it gets zeros.
    fn wants(&self, _i: usize) -> bool {
        true
    }
}

/// Where the particles are: the sorted positions, and the first of each cell.
#[derive(Clone, Copy)]
pub(crate) struct Sorted<'a> {
    pub grid: &'a Grid,
    /// One entry per cell, then the number of the living: see [`Cells::cell_start`](crate::cells::Cells::cell_start).
    pub cell_start: &'a [u32],
    /// In metres, by cell.
    pub positions: &'a [Vec4],
    /// Nothing is a neighbour beyond it, in metres.
    pub support_radius: f32,
}

impl<'a> Sorted<'a> {
    /// Of a pass's slots.
    pub fn new(params: &Params, grid: &'a Grid, cell_start: &'a [u32], positions: &'a [Vec4]) -> Self {
        Self { grid, cell_start, positions, support_radius: params.support_radius }
    }
}

/// Runs a pass over all living particles; `outputs` are theirs, in the same order.
///
/// A particle's result depends on nothing but its input, so that the number of threads changes no bit.
pub(crate) fn for_each<const F: usize, const S: usize, P: PairSum<F, S>>(
    sorted: Sorted<'_>,
    outputs: &mut [P::Output],
    pass: &P,
) {
    for_each_with(Simd::in_use(), sorted, outputs, pass);
}

fn for_each_with<const F: usize, const S: usize, P: PairSum<F, S>>(
    simd: Simd,
    sorted: Sorted<'_>,
    outputs: &mut [P::Output],
    pass: &P,
) {
    let living = sorted.cell_start[sorted.grid.cell_count as usize] as usize;
    let columns = &Columns::new(living, |j| pass.load(j));
    rows(sorted, outputs)
        .into_par_iter()
        .with_max_len(8)
        .for_each_init(Candidates::new, |candidates, (row, outputs)| {
            run_with(simd, Row { sorted, columns, candidates, row, outputs, pass })
        });
}

/// The rows of cells that hold particles, each with the outputs of its particles.
fn rows<'a, T>(sorted: Sorted<'_>, mut outputs: &'a mut [T]) -> Vec<(Range<usize>, &'a mut [T])> {
    let mut rows = Vec::new();
    let width = sorted.grid.size_x as usize;
    for first in (0..sorted.grid.cell_count as usize).step_by(width) {
        let particles = sorted.cell_start[first + width] - sorted.cell_start[first];
        if particles > 0 {
            let (piece, rest) = outputs.split_at_mut(particles as usize);
            outputs = rest;
            rows.push((first..first + width, piece));
        }
    }
    rows
}

/// One row of cells.
struct Row<'a, const F: usize, const S: usize, P: PairSum<F, S>> {
    sorted: Sorted<'a>,
    columns: &'a Columns<F>,
    candidates: &'a mut Candidates<F>,
    row: Range<usize>,
    outputs: &'a mut [P::Output],
    pass: &'a P,
}

impl<const F: usize, const S: usize, P: PairSum<F, S>> Leaf for Row<'_, F, S, P> {
    #[inline(always)]
    fn run<V: Register>(self) {
        let Self { sorted, columns, candidates, row, outputs, pass } = self;
        let first = sorted.cell_start[row.start] as usize;
        for cell in row {
            let places = sorted.cell_start[cell] as usize..sorted.cell_start[cell + 1] as usize;
            if places.clone().any(|i| pass.wants(i)) {
                candidates.gather::<V>(columns, &Surroundings::new(&sorted, cell, places.clone()));
            }
            for i in places {
                let sums = if pass.wants(i) { candidates.sum::<V, S>(pass.pair::<V>(i)) } else { [0.0; S] };
                pass.finish(i, sums, &mut outputs[i - first]);
            }
        }
    }
}
