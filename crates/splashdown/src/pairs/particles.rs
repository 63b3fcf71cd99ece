//! Sums over the neighbours of every particle.

use std::ops::{AddAssign, Range};

use rayon::prelude::*;

use super::Sorted;
use super::candidates::{Candidates, Region};
use super::columns::Columns;
use super::vector::{reflected_point, splat};
use crate::boundary::Reflection;
use crate::simd::{Leaf, Register, Simd, run_with};

/// A pass that sums `S` quantities over the neighbours of every particle, including itself, from
/// `F` columns. The first three columns are the position.
///
/// Functions with registers as arguments must be `#[inline(always)]`.
pub(crate) trait PairSum<const F: usize, const S: usize>: Sync {
    /// The result of a particle.
    type Output: Send;

    /// Whether the formula of a pair takes so long that it is worth while to pack the neighbours first, a quarter of the
    /// candidates. Those at the support radius or beyond are then left out, whatever the formula makes of them.
    const IS_LONG: bool = S > 4;

    /// The values of particle `j` in the columns. The contribution of a pair must be zero if the
    /// columns after the position are zero, or beyond the support radius.
    fn load(&self, j: usize) -> [f32; F];

    /// The contributions of a register of neighbours to the sums of particle `i`.
    fn pair<V: Register>(&self, i: usize) -> impl Fn([V; F]) -> [V; S];

    /// The result of particle `i` for its sums.
    fn finish(&self, i: usize, sums: [f32; S]) -> Self::Output;

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

/// Where results of particles are stored.
pub(crate) trait Outputs<T>: Send + Sized {
    /// Divides it before particle `middle`.
    fn split_at(self, middle: usize) -> (Self, Self);
    /// Stores the result of particle `i`.
    fn put(&mut self, i: usize, value: T);
}

impl<T: Send> Outputs<T> for &mut [T] {
    fn split_at(self, middle: usize) -> (Self, Self) {
        self.split_at_mut(middle)
    }

    #[inline(always)]
    fn put(&mut self, i: usize, value: T) {
        self[i] = value;
    }
}

/// Adds results to values.
pub(crate) struct Added<'a, T>(pub &'a mut [T]);

impl<T: Send + Copy + AddAssign> Outputs<T> for Added<'_, T> {
    fn split_at(self, middle: usize) -> (Self, Self) {
        let (first, second) = self.0.split_at_mut(middle);
        (Self(first), Self(second))
    }

    #[inline(always)]
    fn put(&mut self, i: usize, value: T) {
        self.0[i] += value;
    }
}

/// Two results per particle.
impl<A, B, X: Outputs<A>, Y: Outputs<B>> Outputs<(A, B)> for (X, Y) {
    fn split_at(self, middle: usize) -> (Self, Self) {
        let (first, second) = (self.0.split_at(middle), self.1.split_at(middle));
        ((first.0, second.0), (first.1, second.1))
    }

    #[inline(always)]
    fn put(&mut self, i: usize, (a, b): (A, B)) {
        self.0.put(i, a);
        self.1.put(i, b);
    }
}

/// Runs a pass over all active particles. `outputs` takes their results, in the same order.
pub(crate) fn for_each<const F: usize, const S: usize, P: PairSum<F, S>>(
    sorted: Sorted<'_>,
    outputs: impl Outputs<P::Output>,
    pass: &P,
) {
    for_each_with(Simd::in_use(), sorted, outputs, pass);
}

pub(super) fn for_each_with<const F: usize, const S: usize, P: PairSum<F, S>>(
    simd: Simd,
    sorted: Sorted<'_>,
    outputs: impl Outputs<P::Output>,
    pass: &P,
) {
    let columns = &Columns::new(sorted.active_count(), |j| pass.load(j));
    rows(sorted, outputs).into_par_iter().with_max_len(8).for_each_init(
        || [const { Candidates::new() }; 2],
        |candidates, (row, outputs)| run_with(simd, Row { sorted, columns, candidates, row, outputs, pass }),
    );
}

/// The rows of cells that contain particles, each with the outputs of its particles.
fn rows<T, O: Outputs<T>>(sorted: Sorted<'_>, outputs: O) -> Vec<(Range<usize>, O)> {
    pieces(sorted, outputs, 1)
}

/// Divides the grid into consecutive rows of cells that contain at least `least` particles, except for the last ones, each
/// with the outputs of its particles.
pub(super) fn pieces<T, O: Outputs<T>>(
    sorted: Sorted<'_>,
    mut outputs: O,
    least: usize,
) -> Vec<(Range<usize>, O)> {
    let mut pieces = Vec::new();
    let (width, cells) = (sorted.grid.size_x as usize, sorted.grid.cell_count as usize);
    let mut begin = 0;
    for end in (width..=cells).step_by(width) {
        let particles = sorted.run(begin, end - begin).len();
        if particles >= least || end == cells && particles > 0 {
            let (piece, rest) = outputs.split_at(particles);
            outputs = rest;
            pieces.push((begin..end, piece));
            begin = end;
        } else if particles == 0 {
            begin = end;
        }
    }
    pieces
}

/// One row of cells.
struct Row<'a, const F: usize, const S: usize, P: PairSum<F, S>, O> {
    sorted: Sorted<'a>,
    columns: &'a Columns<F>,
    /// Those near a cube, and those near a particle.
    candidates: &'a mut [Candidates<F>; 2],
    row: Range<usize>,
    outputs: O,
    pass: &'a P,
}

impl<const F: usize, const S: usize, P: PairSum<F, S>, O: Outputs<P::Output>> Leaf for Row<'_, F, S, P, O> {
    #[inline(always)]
    fn run<V: Register>(self) {
        let Self { sorted, columns, candidates, row, mut outputs, pass } = self;
        let [candidates, near] = candidates;
        let reach2 = V::splat(sorted.support_radius * sorted.support_radius);
        let first = sorted.cell_start[row.start] as usize;
        for cube in row.step_by(sorted.grid.slices as usize) {
            let particles = sorted.cube(cube);
            if particles.clone().any(|i| pass.wants(i)) {
                let targets = sorted.positions[particles.clone()].iter().map(|p| p.truncate());
                let region = Region::around(targets, sorted.support_radius);
                let runs = sorted.runs_around(cube);
                let reflections =
                    sorted.images.near(region.low.into(), region.high.into(), sorted.support_radius);
                candidates.pack_images::<V>(columns, &runs, &region, reflections, |by, values| {
                    pass.reflect(by, values)
                });
            }
            for i in particles {
                let sums = if !pass.wants(i) {
                    [0.0; S]
                } else if P::IS_LONG {
                    near.pack_near(candidates, splat::<V>(sorted.positions[i]), reach2);
                    near.sum::<V, S>(pass.pair::<V>(i))
                } else {
                    candidates.sum::<V, S>(pass.pair::<V>(i))
                };
                outputs.put(i - first, pass.finish(i, sums));
            }
        }
    }
}
