//! Neighbour search: particles sorted by the cells of a uniform grid.
//!
//! *How it works.* Counting sort (Hoetzlein 2014): count the particles of every cell, compute the prefix sum, scatter
//! the indices of the particles. Then the particles are copied, within a cell in the order of their ids, so that the
//! result does not depend on the order of the invocations. The integration counts the particles for the sort of the
//! next step; a separate pass counts them where no integration precedes. x is the fastest index of the cells, so that
//! the cells around a particle form nine contiguous ranges of particles (Dominguez et al. 2011). The cells are as wide as
//! the support radius, and on GPUs shorter along x: see [`Grid`]. The bitonic sort of the thesis is an alternative
//! with the same result.
//!
//! *Why not* a hash: the domain is a box, and a dense grid needs one look-up. *Why not* a radix sort: a counting sort is
//! a radix sort of a single digit.

mod bounds;
pub(crate) mod cell_counts;
mod count;
pub(crate) mod grid;
mod keys;
mod reorder;
mod reorder_carried;
mod scatter;
mod sort_order;
mod store_carried;

pub use cell_counts::WGSL as CELL_COUNTS;
pub use grid::{Grid, WGSL as GRID};
pub(crate) use sort_order::sort_order;

use glam::UVec2;
use splashdown_gpu::scan::Scan;
use splashdown_gpu::sort::Sort as BitonicSort;
use splashdown_gpu::{
    Buffer, BufferSet, DispatchSize, Executor, GpuError, PassDesc, Recording, WgslModule, buffer_set,
};

use crate::state::{CarriedArrays, Fields, Reordered, Update, end_step};

/// `row_range`: traversal of neighbours on the GPU.
pub const ROWS: WgslModule = WgslModule { name: "sph/rows", source: include_str!("rows.wgsl") };

/// `neighbour_bits`: the candidates of a row that are neighbours.
pub const CANDIDATES: WgslModule =
    WgslModule { name: "sph/candidates", source: include_str!("candidates.wgsl") };

/// `sorted_index`: the index of a particle after the sort.
pub(crate) const PLACE: WgslModule = WgslModule { name: "sph/place", source: include_str!("place.wgsl") };

/// The algorithm that sorts particles into cells. All give the same result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sort {
    /// Counting sort: histogram, scan, scatter.
    Counting,
    /// Bitonic sort.
    Bitonic,
}

/// The passes of this module.
pub fn passes() -> Vec<&'static PassDesc> {
    vec![
        &reorder::REORDER,
        &reorder_carried::SCALAR,
        &reorder_carried::VECTOR,
        &store_carried::SCALAR,
        &store_carried::VECTOR,
        &bounds::BOUNDS,
        &count::COUNT,
        &keys::KEYS,
        &scatter::SCATTER,
    ]
}

/// The grid and the buffers of the sort.
pub struct Cells {
    /// The grid.
    pub grid: Grid,
    /// The grid as a uniform.
    pub grid_uniform: Buffer<Grid>,
    /// The begin of every cell's particles in the sorted arrays, one entry per cell. Then the begin of the removed
    /// particles, which is the number of active ones; then the number of all particles.
    pub cell_start: Buffer<u32>,
    /// The number of particles of every cell and of removed particles; then the cell of every particle.
    pub cell_counts: Buffer<u32>,
    particles: u32,
    /// Id and index of the particles of every cell, in the order of arrival.
    entries: Buffer<UVec2>,
    sorter: Sorter,
}

enum Sorter {
    Counting(Scan),
    Bitonic { sort: BitonicSort, pairs: Buffer<UVec2> },
}

impl Cells {
    /// Creates the buffers for a grid and a number of particles.
    ///
    /// # Errors
    /// As [`Executor::create`].
    pub fn new(executor: &mut Executor, grid: Grid, particles: u32, sort: Sort) -> Result<Self, GpuError> {
        let n = particles as usize;
        // Removed particles have a cell behind the last.
        let cells = grid.cell_count + 1;
        Ok(Self {
            grid,
            grid_uniform: executor.create_uniform("grid", &grid)?,
            cell_start: executor.create("cell_start", cells as usize + 1)?,
            particles,
            cell_counts: executor.create("cell_counts", cells as usize + n)?,
            entries: executor.create("entries", n)?,
            sorter: match sort {
                Sort::Counting => Sorter::Counting(Scan::new(executor, cells)?),
                Sort::Bitonic => Sorter::Bitonic {
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
        match self.sorter {
            Sorter::Counting(scan) => buffers.add("scan_params", scan.params()),
            Sorter::Bitonic { pairs, .. } => buffers.add("pairs", pairs),
        }
        buffers
    }

    /// True if the sort can be turned off on the device, which the suspension of a step needs.
    pub(crate) fn can_pause(&self) -> bool {
        matches!(self.sorter, Sorter::Counting(_))
    }

    /// Appends the copies of the carried quantities that a step does not change from the sorted arrays back to the
    /// persistent ones.
    pub fn record_store(&self, recording: &mut Recording, fields: &Fields) {
        let buffers = fields.buffers();
        let constant = fields.carried.iter().filter(|carried| carried.quantity.update == Update::Constant);
        for arrays in constant.filter_map(CarriedArrays::reordered) {
            let (pass, buffers) = bound(&buffers, arrays, [&store_carried::SCALAR, &store_carried::VECTOR]);
            recording.dispatch(pass, self.all(), &buffers);
        }
    }

    /// Appends the count that the first sort of a frame needs.
    pub fn record_first_count(&self, recording: &mut Recording, fields: &Fields) {
        // An abandoned frame leaves a count that was not used.
        recording.clear(self.cell_counts);
        self.record_count(recording, fields);
    }

    /// Appends the count for the next step, if the integration does not count.
    pub fn record_count(&self, recording: &mut Recording, fields: &Fields) {
        let buffers = fields.buffers().and(&self.buffers());
        recording.dispatch(&count::COUNT, self.all(), &buffers);
    }

    /// Appends the sort of the persistent arrays, whose particles have been counted, into the sorted arrays, with the
    /// ids into `sorted_ids`. It also ends the previous step, if that has not ended.
    pub fn record_sort(&self, recording: &mut Recording, fields: &Fields, sorted_ids: Buffer<u32>) {
        let buffers = fields.buffers().and(&self.buffers());
        match &self.sorter {
            Sorter::Counting(scan) => {
                scan.record(recording, self.cell_counts, self.cell_start);
                recording.dispatch(&scatter::SCATTER, self.all(), &buffers);
            }
            Sorter::Bitonic { sort, pairs } => {
                recording.append(&end_step::record(fields));
                recording.dispatch(&keys::KEYS, self.all(), &buffers);
                sort.record(recording, *pairs);
                recording.dispatch(&bounds::BOUNDS, DispatchSize::Items(self.particles + 1), &buffers);
            }
        }
        recording.dispatch(&reorder::REORDER, self.all(), &buffers.clone().with("sorted_ids", sorted_ids));
        for arrays in fields.carried.iter().filter_map(CarriedArrays::reordered) {
            let (pass, buffers) =
                bound(&buffers, arrays, [&reorder_carried::SCALAR, &reorder_carried::VECTOR]);
            recording.dispatch(pass, self.all(), &buffers);
        }
    }

    /// An invocation per particle, but at least one, so that steps end and time advances.
    fn all(&self) -> DispatchSize {
        DispatchSize::Items(self.particles.max(1))
    }
}

/// The variant of a pass for the type of a carried quantity, and the buffers with its arrays.
fn bound(
    buffers: &BufferSet,
    arrays: Reordered,
    [scalar, vector]: [&'static PassDesc; 2],
) -> (&'static PassDesc, BufferSet) {
    let buffers = buffers.clone();
    match arrays {
        Reordered::Scalar { persistent, sorted, emitted } => (
            scalar,
            buffers.with("carried", persistent).with("sorted_carried", sorted).with("emitted", emitted),
        ),
        Reordered::Vector { persistent, sorted, emitted } => (
            vector,
            buffers.with("carried", persistent).with("sorted_carried", sorted).with("emitted", emitted),
        ),
    }
}
