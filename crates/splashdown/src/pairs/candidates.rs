//! The particles that may be neighbours of a group of targets, packed into columns.

use std::ops::Range;

use glam::Vec3;

use super::Sorted;
use super::columns::Columns;
use super::vector::{difference, dot, reflected_point};
use crate::boundary::Reflection;
use crate::simd::{BLOCK, Register, sums};

/// Coordinate of the padding: beyond every support radius, with a finite square.
const FAR: f32 = 1e15;
/// Factor on the support radius against rounding.
const MARGIN: f32 = 1.0001;

/// All points within reach of a bounding box.
pub(super) struct Region {
    pub low: [f32; 3],
    pub high: [f32; 3],
    /// Square of the largest distance from the box.
    reach2: f32,
    /// The column with such a square for each particle, which counts instead.
    own_reach2: Option<usize>,
}

impl Region {
    /// The points within the support radius of the bounding box of some points.
    #[inline(always)]
    pub fn around(points: impl IntoIterator<Item = Vec3>, support_radius: f32) -> Self {
        let (mut low, mut high) = ([FAR; 3], [-FAR; 3]);
        for point in points {
            for (axis, x) in point.to_array().into_iter().enumerate() {
                low[axis] = low[axis].min(x);
                high[axis] = high[axis].max(x);
            }
        }
        let reach = MARGIN * support_radius;
        Self { low, high, reach2: reach * reach, own_reach2: None }
    }

    /// The points within the reaches in a column.
    #[inline(always)]
    pub fn with_own_reach2(self, column: Option<usize>) -> Self {
        Self { own_reach2: column, ..self }
    }
}

/// Columns of candidates, in whole blocks.
pub(super) struct Candidates<const F: usize> {
    columns: [Vec<f32>; F],
    /// Number of candidates, including the padding of the last block.
    count: usize,
}

impl<const F: usize> Candidates<F> {
    pub const fn new() -> Self {
        Self { columns: [const { Vec::new() }; F], count: 0 }
    }

    /// Packs the particles of `runs` that are in the region.
    #[inline(always)]
    pub fn pack<V: Register>(&mut self, all: &Columns<F>, runs: &[Range<usize>], region: &Region) {
        self.pack_images::<V>(all, runs, region, std::iter::empty(), |_, values| values);
    }

    /// Packs the particles of `runs` that are in the region, and those of their images that are. `reflect` computes all
    /// columns of an image.
    #[inline(always)]
    pub fn pack_images<V: Register>(
        &mut self,
        all: &Columns<F>,
        runs: &[Range<usize>],
        region: &Region,
        reflections: impl Iterator<Item = Reflection> + Clone,
        reflect: impl Fn(&Reflection, [V; F]) -> [V; F],
    ) {
        let particles: usize = runs.iter().map(|run| run.len()).sum();
        self.reserve(particles * (1 + reflections.clone().count()));
        let mut count = 0;
        for run in runs {
            count = self.append::<V>(all, run.clone(), region, count);
        }
        for reflection in reflections {
            for run in runs {
                let place = |x| reflected_point(&reflection, x);
                let reflect = |values| reflect(&reflection, values);
                count = self.append_with::<V>(all, run.clone(), region, count, place, reflect);
            }
        }
        self.pad(count);
    }

    /// Packs the images of the particles of `runs` that are in the region. `reflect` computes all columns of an image; then
    /// `mark` changes the last ones by the reflection.
    #[inline(always)]
    pub fn pack_only_images<V: Register>(
        &mut self,
        all: &Columns<F>,
        runs: &[Range<usize>],
        region: &Region,
        reflections: impl Iterator<Item = Reflection> + Clone,
        reflect: impl Fn(&Reflection, [V; F]) -> [V; F],
        mark: impl Fn(&Reflection, &mut [f32]),
    ) {
        let particles: usize = runs.iter().map(|run| run.len()).sum();
        self.reserve(particles * reflections.clone().count());
        let mut count = 0;
        for reflection in reflections {
            let begin = count;
            for run in runs {
                let place = |x| reflected_point(&reflection, x);
                let reflect = |values| reflect(&reflection, values);
                count = self.append_with::<V>(all, run.clone(), region, count, place, reflect);
            }
            mark(&reflection, &mut self.columns[F - 1][begin..count]);
        }
        self.pad(count);
    }

    /// Packs the particles in the region and those of their images that are, from all cells within the support radius of
    /// a box. `reflect` computes all columns of an image.
    #[inline(always)]
    pub fn pack_range<V: Register>(
        &mut self,
        all: &Columns<F>,
        sorted: &Sorted<'_>,
        [low, high]: [Vec3; 2],
        region: &Region,
        reflect: impl Fn(&Reflection, [V; F]) -> [V; F],
    ) {
        let reach = MARGIN * sorted.support_radius;
        let runs = sorted.rows_near([low - reach, high + reach]);
        let reflections = sorted.images.near(low, high, sorted.support_radius);
        let particles: usize = runs.clone().map(|run| run.len()).sum();
        self.reserve(particles * (1 + reflections.clone().count()));
        let mut count = 0;
        for run in runs.clone() {
            count = self.append_with::<V>(all, run, region, count, |x| x, |values| values);
        }
        for reflection in reflections {
            for run in runs.clone() {
                let place = |x| reflected_point(&reflection, x);
                let reflect = |values| reflect(&reflection, values);
                count = self.append_with::<V>(all, run, region, count, place, reflect);
            }
        }
        self.pad(count);
    }

    /// Packs those of `all` that are within a distance of a point, whose square is `reach2`.
    #[inline(always)]
    pub fn pack_near<V: Register>(&mut self, all: &Self, x: [V; 3], reach2: V) {
        self.reserve(all.count);
        let from = all.columns();
        let length = self.columns[0].len();
        let to = self.columns.each_mut().map(|column| column.as_mut_ptr());
        assert!(all.count + BLOCK <= length);
        let mut count = 0;
        for k in (0..all.count).step_by(V::WIDTH) {
            let mut values = [V::splat(0.0); F];
            for (value, column) in values.iter_mut().zip(&from) {
                // SAFETY: the count is a multiple of the block, and the width divides the block.
                *value = unsafe { V::load(column.as_ptr().add(k)) };
            }
            let d = difference(x, [values[0], values[1], values[2]]);
            let near = dot(d, d).less_bits(reach2);
            for (to, value) in to.iter().zip(values) {
                // SAFETY: at most as many as in `all` were appended, and there is a block after them.
                unsafe { value.compress(near).store(to.add(count)) };
            }
            count += near.count_ones() as usize;
        }
        self.pad(count);
    }

    /// Enlarges the columns, if necessary, for a number of particles and the padding.
    #[inline(always)]
    fn reserve(&mut self, particles: usize) {
        // A whole register is written at the end, and then the padding.
        let length = particles + 2 * BLOCK;
        if self.columns[0].len() < length {
            self.columns.iter_mut().for_each(|column| column.resize(length, 0.0));
        }
    }

    /// Appends the particles of a run that are in the region to the first `count`; returns the new
    /// count.
    #[inline(always)]
    fn append<V: Register>(
        &mut self,
        all: &Columns<F>,
        run: Range<usize>,
        region: &Region,
        count: usize,
    ) -> usize {
        self.append_with::<V>(all, run, region, count, |x| x, |values| values)
    }

    /// As [`append`](Self::append), for particles that are elsewhere: `place` computes the positions, which decide, and
    /// `change` all columns.
    #[inline(always)]
    fn append_with<V: Register>(
        &mut self,
        all: &Columns<F>,
        run: Range<usize>,
        region: &Region,
        mut count: usize,
        place: impl Fn([V; 3]) -> [V; 3],
        change: impl Fn([V; F]) -> [V; F],
    ) -> usize {
        let from: [&[f32]; F] = std::array::from_fn(|f| all.column(f));
        let length = self.columns[0].len();
        let to = self.columns.each_mut().map(|column| column.as_mut_ptr());
        let (low, high) = (region.low.map(V::splat), region.high.map(V::splat));
        let zero = V::splat(0.0);
        assert!(run.end + BLOCK <= from[0].len(), "a run of particles ends at {}", run.end);
        assert!(count + run.len() + BLOCK <= length, "{} candidates exceed the columns", run.len());
        for j in run.clone().step_by(V::WIDTH) {
            // SAFETY: `j` is below the end of the run, and the columns extend a block beyond it.
            let load = |f: usize| unsafe { V::load(from[f].as_ptr().add(j)) };
            let x = place([load(0), load(1), load(2)]);
            let mut distance2 = zero;
            for axis in 0..3 {
                let outside = (low[axis] - x[axis]).max(x[axis] - high[axis]).max(zero);
                distance2 = distance2 + outside * outside;
            }
            let reach2 = region.own_reach2.map_or(V::splat(region.reach2), load);
            let of_run = u32::MAX >> (32 - V::WIDTH.min(run.end - j));
            let near = distance2.less_bits(reach2) & of_run;
            if near == 0 {
                continue;
            }
            let mut values = [zero; F];
            for (f, value) in values.iter_mut().enumerate() {
                *value = load(f);
            }
            let values = change(values);
            for (to, value) in to.iter().zip(values) {
                // SAFETY: at most the particles of the run were appended, and there is a block
                // after them.
                unsafe { value.compress(near).store(to.add(count)) };
            }
            count += near.count_ones() as usize;
        }
        count
    }

    /// Fills the last block of `count` candidates with padding.
    #[inline(always)]
    fn pad(&mut self, count: usize) {
        for (f, column) in self.columns.iter_mut().enumerate() {
            column[count..count + BLOCK].fill(if f < 3 { FAR } else { 0.0 });
        }
        self.count = count.next_multiple_of(BLOCK);
    }

    /// The columns, with the padding.
    #[inline(always)]
    pub fn columns(&self) -> [&[f32]; F] {
        // Not `from_fn`: the compiler calls it.
        let mut columns: [&[f32]; F] = [&[]; F];
        for (column, values) in columns.iter_mut().zip(&self.columns) {
            *column = &values[..self.count];
        }
        columns
    }

    /// Number of candidates, with the padding.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.count
    }

    /// Visits all registers in order, with the part of a block that they are.
    #[inline(always)]
    pub fn visit<V: Register>(&self, mut visit: impl FnMut(usize, [V; F])) {
        let columns = self.columns();
        for block in (0..self.count).step_by(BLOCK) {
            for part in 0..BLOCK / V::WIDTH {
                // Not `map`: for many columns the compiler calls it, which passes registers in memory.
                let mut values = [V::splat(0.0); F];
                for (value, column) in values.iter_mut().zip(&columns) {
                    // SAFETY: the count is a multiple of the block, and the width divides the block.
                    *value = unsafe { V::load(column.as_ptr().add(block + part * V::WIDTH)) };
                }
                visit(part, values);
            }
        }
    }

    /// The sums of one target.
    #[inline(always)]
    pub fn sum<V: Register, const S: usize>(&self, pair: impl Fn([V; F]) -> [V; S]) -> [f32; S] {
        let columns = self.columns();
        let mut lanes = [[0.0; BLOCK]; S];
        // Narrow registers process one part of every block after the other, which keeps few sums
        // alive.
        for part in (0..BLOCK).step_by(V::WIDTH) {
            let mut sums = [V::splat(0.0); S];
            for k in (part..self.count).step_by(BLOCK) {
                // Not `map`: for many columns the compiler calls it, which passes registers in memory.
                let mut values = [V::splat(0.0); F];
                for (value, column) in values.iter_mut().zip(&columns) {
                    // SAFETY: the count is a multiple of the block, and the width divides the block.
                    *value = unsafe { V::load(column.as_ptr().add(k)) };
                }
                let contributions = pair(values);
                for s in 0..S {
                    sums[s] = sums[s] + contributions[s];
                }
            }
            for (lanes, sums) in lanes.iter_mut().zip(sums) {
                // SAFETY: the width divides the block.
                unsafe { sums.store(lanes.as_mut_ptr().add(part)) };
            }
        }
        sums(&lanes)
    }
}

/// Sums in the lanes of a block, for [`Candidates::visit`].
pub(super) struct Sums<V, const S: usize>([[V; S]; PARTS]);

/// The most registers of a block.
const PARTS: usize = BLOCK / 4;

impl<V: Register, const S: usize> Sums<V, S> {
    #[inline(always)]
    pub fn new() -> Self {
        Self([[V::splat(0.0); S]; PARTS])
    }

    #[inline(always)]
    pub fn add(&mut self, part: usize, contributions: [V; S]) {
        for (sum, contribution) in self.0[part].iter_mut().zip(contributions) {
            *sum = *sum + contribution;
        }
    }

    /// The sums over all lanes.
    #[inline(always)]
    pub fn totals(&self) -> [f32; S] {
        let mut lanes = [[0.0; BLOCK]; S];
        for (part, sums) in self.0.iter().take(BLOCK / V::WIDTH).enumerate() {
            for (lanes, sum) in lanes.iter_mut().zip(sums) {
                // SAFETY: the width divides the block.
                unsafe { sum.store(lanes.as_mut_ptr().add(part * V::WIDTH)) };
            }
        }
        sums(&lanes)
    }
}
