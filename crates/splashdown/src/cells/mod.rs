//! Neighbour search: particles sorted by the cells of a uniform grid.
//!
//! *How it works.* Counting sort (Hoetzlein 2014): count the particles of every cell, prefix sum, scatter their
//! numbers; then copy them, each cell's few in order of id, so that the result does not depend on the order of
//! the invocations. The pass that moves particles counts them for the next step's sort; only where nothing
//! moved before does a pass of its own. x runs fastest in the numbers of the cells, so that the 27 cells round
//! a particle are nine contiguous runs of particles (Dominguez et al. 2011). The thesis's bitonic sort is there
//! as a second way with the same result.
//!
//! *Why not* a hash: the domain is a box, and its dense grid is one look-up. *Why not* a radix sort: a counting sort is
//! one, of a single digit.

mod bounds;
pub(crate) mod cell_counts;
mod count;
pub(crate) mod grid;
mod keys;
mod reorder;
mod scatter;

pub use cell_counts::WGSL as CELL_COUNTS;
pub use grid::{Grid, WGSL as GRID};

use glam::UVec2;
use splashdown_gpu::scan::Scan;
use splashdown_gpu::sort::Sort as BitonicSort;
use splashdown_gpu::{
    Buffer, BufferSet, DispatchSize, Executor, GpuError, PassDesc, Recording, WgslModule, buffer_set,
};

use crate::state::{Fields, end_step};

/// `row_range`: how the GPU visits neighbours.
pub const ROWS: WgslModule = WgslModule { name: "sph/rows", source: include_str!("rows.wgsl") };

/// How particles are sorted into cells. The results are the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sort {
    /// Counting sort: a histogram, a scan, a scatter.
    Counting,
    /// Bitonic sort.
    Bitonic,
}

/// The passes of this module.
pub fn passes() -> Vec<&'static PassDesc> {
    vec![&reorder::REORDER, &bounds::BOUNDS, &count::COUNT, &keys::KEYS, &scatter::SCATTER]
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
    /// How many particles every cell has, one entry per cell and one for the dead; then the cell of every particle.
    pub cell_counts: Buffer<u32>,
    particles: u32,
    /// Id and number of the particles of every cell, in the order of their arrival.
    entries: Buffer<UVec2>,
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
            cell_counts: executor.create("cell_counts", cells as usize + n)?,
            entries: executor.create("entries", n)?,
            way: match sort {
                Sort::Counting => Way::Counting(Scan::new(executor, cells)?),
                Sort::Bitonic => Way::Bitonic {
                    sort: BitonicSort::new(executor, particles)?,
                    pairs: executor.create("pairs", n)?,
                },
            },
        })
    }

    /// The buffers by name, for recordings.
    pub fn buffers(&self) -> BufferSet {
        let mut buffers = buffer_set!(self => cell_start, cell_counts, entries);
        buffers.add("grid", self.grid_uniform);
        if let Way::Bitonic { pairs, .. } = self.way {
            buffers.add("pairs", pairs);
        }
        buffers
    }

    /// Appends the count that the first sort of a frame needs.
    pub fn record_first_count(&self, recording: &mut Recording, fields: &Fields) {
        // An abandoned frame leaves a count that was not used.
        recording.clear(self.cell_counts);
        self.record_count(recording, fields);
    }

    /// Appends the count for the next step where the pass that moves particles does not count.
    pub fn record_count(&self, recording: &mut Recording, fields: &Fields) {
        let buffers = fields.buffers().and(&self.buffers());
        recording.dispatch(&count::COUNT, self.all(), &buffers);
    }

    /// Appends the sort of the persistent arrays, whose particles have been counted, into the sorted ones, ids
    /// into `sorted_ids`; and ends the step before, if there is one.
    pub fn record_sort(&self, recording: &mut Recording, fields: &Fields, sorted_ids: Buffer<u32>) {
        let buffers = fields.buffers().and(&self.buffers());
        match &self.way {
            Way::Counting(scan) => {
                scan.record(recording, self.cell_counts, self.cell_start);
                recording.dispatch(&scatter::SCATTER, self.all(), &buffers);
            }
            Way::Bitonic { sort, pairs } => {
                recording.append(&end_step::record(fields));
                recording.dispatch(&keys::KEYS, self.all(), &buffers);
                sort.record(recording, *pairs);
                recording.dispatch(&bounds::BOUNDS, DispatchSize::Items(self.particles + 1), &buffers);
            }
        }
        recording.dispatch(&reorder::REORDER, self.all(), &buffers.with("sorted_ids", sorted_ids));
    }

    /// An invocation per particle; one where there is none, so that steps end and time advances.
    fn all(&self) -> DispatchSize {
        DispatchSize::Items(self.particles.max(1))
    }
}
