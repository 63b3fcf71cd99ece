//! Lists of the neighbours of every particle with a factor for each, such as that of the gradient of the kernel, for passes
//! that visit the same neighbours many times in a step.
//!
//! A visit of the candidates tests four times as many particles as there are neighbours, and a formula takes a square root.
//! A list is made in one such visit, which also computes sums; a visit of a list takes a seventh of that. A
//! neighbour takes 8 bytes: the factor and its index. Subtracting the positions again costs less than reading their
//! difference. Images behind walls are few and take 16 bytes: the vector, and bits for index and reflection.
//!
//! The neighbours of four particles lie side by side (`list`), and registers contain a vector for each of the four. The sums
//! of four particles are then complete without adding up lanes, no neighbours remain that do not fill a register, and the
//! number of neighbours, which the processor cannot predict, matters once for four particles.

mod list;
mod make;

use std::marker::PhantomData;

use glam::{UVec3, Vec3, Vec4};
use rayon::prelude::*;

use self::list::{List, Visit};
use self::make::{Cells, NoSum, Nothing};
use super::Sorted;
use super::candidates::Candidates;
use super::columns::Columns;
use super::near::{Formula, NearImages};
use super::particles::{Outputs, pieces};
use super::vectors;
use crate::boundary::Images;
use crate::kernel::Kernel;
use crate::simd::{Lanes, Simd, run_with};
pub(crate) use make::{ListedPair, ListedSum};

/// Number of lists, up to rounding, which is that of tasks.
const LISTS: usize = 64;

/// Positions per task that compares them.
const CHUNK: usize = 1 << 14;

/// Bits of the index of a neighbour. Above them are three bits, the axes of the reflection of an image.
pub(super) const INDEX_BITS: u32 = 27;

/// More particles could make it infinite.
const MOST: usize = 15 << 23;

/// A function of the distance that a list contains as a factor on the difference of the positions.
pub(crate) trait Radial: Send + Sync + 'static {
    /// The factor at a distance of q support radii; zero beyond the support.
    fn factor<V: Lanes>(q: V) -> V;
}

/// The gradient of a kernel times the fifth power of the support radius.
impl<K: Kernel> Radial for K {
    #[inline(always)]
    fn factor<V: Lanes>(q: V) -> V {
        K::g(q)
    }
}

/// Lists of neighbours, and what they were made from.
pub(crate) struct NeighbourLists<R> {
    lists: Vec<List>,
    /// The positions that the lists belong to.
    positions: Vec<Vec4>,
    /// What else they belong to.
    made_for: Option<Conditions>,
    /// The registers of the sums.
    simd: Simd,
    factor: PhantomData<R>,
}

/// What lists depend on besides the positions: support radius, images, and the origin, the size and the slices of the grid.
type Conditions = (f32, Images, Vec3, UVec3, u32);

fn conditions(sorted: Sorted<'_>) -> Conditions {
    let Sorted { grid, support_radius, images, .. } = sorted;
    (support_radius, images, grid.origin, grid.size(), grid.slices)
}

/// Whether all bits are equal.
fn are_same(a: &[Vec4], b: &[Vec4]) -> bool {
    let bits = |positions| bytemuck::cast_slice::<Vec4, u8>(positions);
    let pairs = a.par_chunks(CHUNK).zip(b.par_chunks(CHUNK));
    a.len() == b.len() && pairs.all(|(a, b)| bits(a) == bits(b))
}

impl<R> Default for NeighbourLists<R> {
    fn default() -> Self {
        let (lists, positions, factor) = (Vec::new(), Vec::new(), PhantomData);
        Self { lists, positions, made_for: None, simd: Simd::Portable, factor }
    }
}

impl<R: Radial> NeighbourLists<R> {
    /// The lists for these particles; makes them unless they exist.
    pub fn of(&mut self, sorted: Sorted<'_>) -> &Self {
        self.of_with(Simd::in_use(), sorted)
    }

    pub(super) fn of_with(&mut self, simd: Simd, sorted: Sorted<'_>) -> &Self {
        let positions = &sorted.positions[..sorted.active_count()];
        if self.made_for != Some(conditions(sorted)) || !are_same(&self.positions, positions) {
            let pass = NoSum::<R>::new(positions, sorted.support_radius);
            self.make_with(simd, sorted, Nothing, &pass);
        }
        self
    }

    /// The lists of the last call; makes them if they belong to another number of particles or to other conditions. Only
    /// for particles that have not moved since: unlike [`of`](Self::of), it does not compare the positions.
    pub fn kept(&mut self, sorted: Sorted<'_>) -> &Self {
        let has_same_count = self.positions.len() == sorted.active_count();
        if has_same_count && self.made_for == Some(conditions(sorted)) { self } else { self.of(sorted) }
    }

    /// Makes the lists, and runs a pass over the neighbours in the same visit.
    pub fn make<const F: usize, const S: usize, P: ListedSum<F, S>>(
        &mut self,
        sorted: Sorted<'_>,
        outputs: impl Outputs<P::Output>,
        pass: &P,
    ) {
        self.make_with(Simd::in_use(), sorted, outputs, pass);
    }

    pub(super) fn make_with<const F: usize, const S: usize, P: ListedSum<F, S>>(
        &mut self,
        simd: Simd,
        sorted: Sorted<'_>,
        outputs: impl Outputs<P::Output>,
        pass: &P,
    ) {
        let count = sorted.active_count();
        assert!(count <= MOST, "{count} particles are more than {MOST}");
        let columns = &Columns::new(count, |j| pass.load(j));
        let pieces = pieces(sorted, outputs, least(sorted));
        // Lists that are not needed now are empty and keep their memory.
        self.lists.resize_with(self.lists.len().max(pieces.len()), List::default);
        self.lists[pieces.len()..].iter_mut().for_each(List::clear);
        self.lists.par_iter_mut().zip(pieces).with_max_len(1).for_each_init(
            || [const { Candidates::new() }; 3],
            |candidates, (list, (cells, outputs))| {
                list.clear();
                run_with(simd, Cells { sorted, columns, candidates, cells, list, outputs, pass });
            },
        );
        self.positions.clear();
        self.positions.extend_from_slice(&sorted.positions[..count]);
        (self.made_for, self.simd) = (Some(conditions(sorted)), simd);
    }

    /// Computes the results of all particles from their index, the sum of a formula over their neighbours, and their images
    /// that are neighbours.
    pub fn for_each<T>(
        &self,
        sorted: Sorted<'_>,
        outputs: impl Outputs<T>,
        formula: &impl Formula,
        result: impl Fn(usize, Vec4, NearImages<'_>) -> T + Sync,
    ) {
        assert!(self.positions.len() <= formula.count(), "{} vectors are too few", formula.count());
        let pieces = pieces(sorted, outputs, least(sorted));
        self.lists.par_iter().zip(pieces).with_max_len(1).for_each(|(list, (cells, outputs))| {
            let first = sorted.cell_start[cells.start] as usize;
            // SAFETY: all lists were made from `positions`, so that their indices are below this number.
            let visit = unsafe { Visit::new(list, first, outputs, formula, &result) };
            vectors::run_with(self.simd, visit);
        });
    }

    /// The neighbours of all particles.
    #[cfg(test)]
    pub(super) fn neighbours(&self, sorted: Sorted<'_>) -> Vec<Vec<usize>> {
        let pieces = pieces(sorted, Nothing, least(sorted));
        self.lists.iter().zip(pieces).flat_map(|(list, _)| list.indices()).collect()
    }
}

/// Particles per list. Equal numbers keep the sizes of the lists similar from step to step: memory that a list grows into
/// is new, and the system would have to clear it.
fn least(sorted: Sorted<'_>) -> usize {
    (sorted.active_count() / LISTS).max(1)
}
