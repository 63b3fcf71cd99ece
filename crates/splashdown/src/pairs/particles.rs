//! Sums over the neighbours of every particle.

use std::ops::Range;

use rayon::prelude::*;

use super::Sorted;
use super::candidates::{Candidates, Region};
use super::columns::Columns;
use super::vector::reflected_point;
use crate::boundary::Reflection;
use crate::simd::{Leaf, Register, Simd, run_with};

/// A pass that sums `S` quantities over the neighbours of every particle, including itself, from
/// `F` columns. The first three columns are the position.
///
/// Functions with registers as arguments must be `#[inline(always)]`.
pub(crate) trait PairSum<const F: usize, const S: usize>: Sync {
    /// The result of a particle.
    type Output: Send;

    /// The values of particle `j` in the columns. The contribution of a pair must be zero if the
    /// columns after the position are zero, or beyond the support radius.
    fn load(&self, j: usize) -> [f32; F];

    /// The contributions of a register of neighbours to the sums of particle `i`.
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; F]) -> [V; S];

    /// Computes the result of particle `i` from its sums.
    fn finish(&self, i: usize, sums: [f32; S], out: &mut Self::Output);

    /// The columns of the images of a register of neighbours behind a wall.
    #[inline(always)]
    fn reflect<V: Register>(&self, reflection: &Reflection, values: [V; F]) -> [V; F] {
        let mut image = values;
        image[..3].copy_from_slice(&reflected_point(reflection, [values[0], values[1], values[2]]));
        image
    }

    /// Whether the sums of particle `i` are needed. If not, they are zero.
    fn wants(&self, _i: usize) -> bool {
        true
    }
}

/// Runs a pass over all active particles. `outputs` has their results, in the same order.
pub(crate) fn for_each<const F: usize, const S: usize, P: PairSum<F, S>>(
    sorted: Sorted<'_>,
    outputs: &mut [P::Output],
    pass: &P,
) {
    for_each_with(Simd::in_use(), sorted, outputs, pass);
}

pub(super) fn for_each_with<const F: usize, const S: usize, P: PairSum<F, S>>(
    simd: Simd,
    sorted: Sorted<'_>,
    outputs: &mut [P::Output],
    pass: &P,
) {
    let columns = &Columns::new(sorted.active_count(), |j| pass.load(j));
    rows(sorted, outputs)
        .into_par_iter()
        .with_max_len(8)
        .for_each_init(Candidates::new, |candidates, (row, outputs)| {
            run_with(simd, Row { sorted, columns, candidates, row, outputs, pass })
        });
}

/// The rows of cells that contain particles, each with the outputs of its particles.
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
            let particles = sorted.run(cell, 1);
            if particles.clone().any(|i| pass.wants(i)) {
                let targets = sorted.positions[particles.clone()].iter().map(|p| p.truncate());
                let region = Region::around(targets, sorted.support_radius);
                let runs = sorted.runs_around(cell);
                let reflections =
                    sorted.images.near(region.low.into(), region.high.into(), sorted.support_radius);
                candidates.pack_images::<V>(columns, &runs, &region, reflections, |by, values| {
                    pass.reflect(by, values)
                });
            }
            for i in particles {
                let sums = if pass.wants(i) { candidates.sum::<V, S>(pass.pair::<V>(i)) } else { [0.0; S] };
                pass.finish(i, sums, &mut outputs[i - first]);
            }
        }
    }
}
