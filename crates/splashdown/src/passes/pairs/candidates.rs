//! The particles that may be neighbours of those in one cell.

use std::ops::Range;

use super::Sorted;
use super::columns::Columns;
use crate::simd::{BLOCK, Register, sum};

/// Coordinate of the padding: far from everything, and its square is finite.
const FAR: f32 = 1e15;
/// How much wider than the support it is looked, against rounding.
const MARGIN: f32 = 1.0001;

/// What lies round a cell.
pub(super) struct Surroundings {
    /// The nine runs of particles, which are the rows of three cells each.
    runs: [Range<usize>; 9],
    /// The box round the cell's particles.
    low: [f32; 3],
    high: [f32; 3],
    /// The square of how far from the box a neighbour may be.
    reach2: f32,
}

impl Surroundings {
    /// Of a cell that holds the particles at `places`.
    #[inline(always)]
    pub fn new(sorted: &Sorted<'_>, cell: usize, places: Range<usize>) -> Self {
        let (width, plane) =
            (sorted.grid.size_x as usize, (sorted.grid.size_x * sorted.grid.size_y) as usize);
        let runs = std::array::from_fn(|k| {
            let first = cell + k / 3 * plane + k % 3 * width - plane - width - 1;
            sorted.cell_start[first] as usize..sorted.cell_start[first + 3] as usize
        });
        let (mut low, mut high) = ([FAR; 3], [-FAR; 3]);
        for position in &sorted.positions[places] {
            for (axis, x) in position.to_array()[..3].iter().enumerate() {
                low[axis] = low[axis].min(*x);
                high[axis] = high[axis].max(*x);
            }
        }
        let reach = MARGIN * sorted.support_radius;
        Self { runs, low, high, reach2: reach * reach }
    }
}

/// Columns of the candidates, in whole blocks.
pub(super) struct Candidates<const F: usize> {
    columns: [Vec<f32>; F],
    /// How many lie in the columns, those of the padding that fill the last block included.
    count: usize,
}

impl<const F: usize> Candidates<F> {
    pub fn new() -> Self {
        Self { columns: [const { Vec::new() }; F], count: 0 }
    }

    /// Takes those particles of the surroundings that are within reach.
    #[inline(always)]
    pub fn gather<V: Register>(&mut self, all: &Columns<F>, surroundings: &Surroundings) {
        // A register is written whole, wherever the last candidate ends, and then the padding.
        let room = surroundings.runs.iter().map(|run| run.len()).sum::<usize>() + 2 * BLOCK;
        if self.columns[0].len() < room {
            self.columns.iter_mut().for_each(|column| column.resize(room, 0.0));
        }
        let from: [&[f32]; F] = std::array::from_fn(|f| all.column(f));
        let to = self.columns.each_mut().map(|column| column.as_mut_ptr());
        let (low, high) = (surroundings.low.map(V::splat), surroundings.high.map(V::splat));
        let (zero, reach2) = (V::splat(0.0), V::splat(surroundings.reach2));
        let mut count = 0;
        for run in &surroundings.runs {
            assert!(run.end + BLOCK <= from[0].len(), "a run of particles ends at {}", run.end);
            for j in run.clone().step_by(V::WIDTH) {
                // SAFETY: `j` is below the end of the run, and a block follows every run.
                let load = |f: usize| unsafe { V::load(from[f].as_ptr().add(j)) };
                let mut distance2 = zero;
                for axis in 0..3 {
                    let x = load(axis);
                    let outside = (low[axis] - x).max(x - high[axis]).max(zero);
                    distance2 = distance2 + outside * outside;
                }
                let of_run = u32::MAX >> (32 - V::WIDTH.min(run.end - j));
                let near = distance2.less_bits(reach2) & of_run;
                if near == 0 {
                    continue;
                }
                for (f, to) in to.iter().enumerate() {
                    // SAFETY: at most the particles of the runs so far were counted, and two blocks are behind them.
                    unsafe { load(f).compress(near).store(to.add(count)) };
                }
                count += near.count_ones() as usize;
            }
        }
        for (f, column) in self.columns.iter_mut().enumerate() {
            column[count..count + BLOCK].fill(if f < 3 { FAR } else { 0.0 });
        }
        self.count = count.next_multiple_of(BLOCK);
    }

    /// The sums of a particle.
    #[inline(always)]
    pub fn sum<V: Register, const S: usize>(&self, pair: impl Fn([V; F]) -> [V; S]) -> [f32; S] {
        let columns: [&[f32]; F] = self.columns.each_ref().map(|column| &column[..self.count]);
        let mut lanes = [[0.0; BLOCK]; S];
        // Narrow registers take a part of each block after the other, so that all keep few sums.
        for part in (0..BLOCK).step_by(V::WIDTH) {
            let mut sums = [V::splat(0.0); S];
            for k in (part..self.count).step_by(BLOCK) {
                // SAFETY: the count is a multiple of the block, and the width divides it.
                let values = columns.map(|column| unsafe { V::load(column.as_ptr().add(k)) });
                let shares = pair(values);
                for s in 0..S {
                    sums[s] = sums[s] + shares[s];
                }
            }
            for (lanes, sums) in lanes.iter_mut().zip(sums) {
                // SAFETY: the width divides the block.
                unsafe { sums.store(lanes.as_mut_ptr().add(part)) };
            }
        }
        lanes.map(sum)
    }
}
