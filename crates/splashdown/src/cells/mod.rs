//! Neighbour search: particles sorted by the cells of a uniform grid.
//!
//! *How it works.* Counting sort (Hoetzlein 2014): count the particles of every cell, prefix sum, scatter; then order
//! each cell's few particles by id, so that the result does not depend on the order of the invocations. x runs fastest
//! in the numbers of the cells, so that the 27 cells round a particle are nine contiguous runs of particles
//! (Dominguez et al. 2011). The thesis's bitonic sort is there as a second way with the same result.
//!
//! *Why not* a hash: the domain is a box, and its dense grid is one look-up. *Why not* a radix sort: a counting sort is
//! one, of a single digit.

mod bounds;
mod count;
pub(crate) mod grid;
mod keys;
mod order;
mod reorder;
mod scatter;

pub use grid::{Grid, WGSL as GRID};

use glam::UVec2;
use splashdown_gpu::scan::Scan;
use splashdown_gpu::sort::Sort as BitonicSort;
use splashdown_gpu::{Buffer, Executor, GpuError, Grid as Extent, PassDesc, Recording};

use crate::fields::Fields;
use crate::scene::Sort;

/// The passes of this module.
pub fn passes() -> Vec<&'static PassDesc> {
    vec![&bounds::BOUNDS, &count::COUNT, &keys::KEYS, &order::ORDER, &reorder::REORDER, &scatter::SCATTER]
}

/// The grid and the buffers of the sort.
pub struct Cells {
    /// The grid.
    pub grid: Grid,
    /// The grid as a uniform.
    pub grid_uniform: Buffer<Grid>,
    /// Where every cell's particles begin in the sorted arrays: one entry per cell; then one for the dead, which is the
    /// number of the living; then the number of all.
    pub cell_start: Buffer<u32>,
    particles: u32,
    counts: Buffer<u32>,
    cell_rank: Buffer<UVec2>,
    slots: Buffer<u32>,
    order: Buffer<u32>,
    way: Way,
}

enum Way {
    Counting(Scan),
    Bitonic { sort: BitonicSort, pairs: Buffer<UVec2> },
}

impl Cells {
    /// Makes the buffers for a grid and a number of particles.
    ///
    /// # Errors
    /// As [`Executor::create`].
    pub fn new(executor: &mut Executor, grid: Grid, particles: u32, sort: Sort) -> Result<Self, GpuError> {
        let n = particles as usize;
        // The dead have a cell behind the last.
        let cells = grid.cell_count + 1;
        Ok(Self {
            grid,
            grid_uniform: executor.create_uniform("grid", &grid)?,
            cell_start: executor.create("cell_start", cells as usize + 1)?,
            particles,
            counts: executor.create("cell counts", cells as usize)?,
            cell_rank: executor.create("cell_rank", n)?,
            slots: executor.create("slots", n)?,
            order: executor.create("order", n)?,
            way: match sort {
                Sort::Counting => Way::Counting(Scan::new(executor, cells)?),
                Sort::Bitonic => Way::Bitonic {
                    sort: BitonicSort::new(executor, particles)?,
                    pairs: executor.create("pairs", n)?,
                },
            },
        })
    }

    /// Appends the sort of the resting arrays into the sorted ones.
    pub fn record(&self, recording: &mut Recording, fields: &Fields) {
        let all = Extent::Items(self.particles);
        let (state, grid) = (fields.state.id(), self.grid_uniform.id());
        let (cell_rank, cell_start, slots) = (self.cell_rank.id(), self.cell_start.id(), self.slots.id());
        recording.clear(self.counts);
        recording.dispatch(
            &count::COUNT,
            all,
            &[
                fields.params.id(),
                grid,
                state,
                fields.positions.id(),
                fields.velocities.id(),
                cell_rank,
                self.counts.id(),
                fields.tally.id(),
            ],
        );
        match &self.way {
            Way::Counting(scan) => {
                scan.record(recording, self.counts, self.cell_start);
                recording.dispatch(&scatter::SCATTER, all, &[state, cell_rank, cell_start, slots]);
            }
            Way::Bitonic { sort, pairs } => {
                recording.dispatch(&keys::KEYS, all, &[state, cell_rank, pairs.id()]);
                sort.record(recording, *pairs);
                let one_more = Extent::Items(self.particles + 1);
                recording.dispatch(&bounds::BOUNDS, one_more, &[grid, state, pairs.id(), cell_start, slots]);
            }
        }
        recording.dispatch(
            &order::ORDER,
            all,
            &[state, cell_rank, cell_start, slots, fields.ids.id(), self.order.id()],
        );
        recording.dispatch(
            &reorder::REORDER,
            all,
            &[
                state,
                self.order.id(),
                fields.positions.id(),
                fields.velocities.id(),
                fields.ids.id(),
                fields.sorted_positions.id(),
                fields.sorted_velocities.id(),
                fields.sorted_ids.id(),
            ],
        );
    }
}
