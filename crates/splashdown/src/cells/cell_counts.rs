//! Access to the counts and cells of particles in passes on the CPU.

use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering::Relaxed;

use splashdown_gpu::{WgslModule, as_atomic};

use super::Grid;

/// The WGSL side: `count_particle` and `is_outside`.
pub const WGSL: WgslModule = WgslModule { name: "sph/cell_counts", source: include_str!("cell_counts.wgsl") };

/// Splits `cell_counts` into the counts of the cells, the last of which is that of removed particles, and the cells of
/// the particles.
pub(crate) fn split<'a>(grid: &Grid, cell_counts: &'a mut [u32]) -> (&'a [AtomicU32], &'a mut [u32]) {
    let (counts, cells) = cell_counts.split_at_mut(grid.cell_count as usize + 1);
    (as_atomic(counts), cells)
}

/// Counts particles one after the other. Neighbours in the arrays are mostly neighbours in space: consecutive particles
/// of the same cell are counted together, which saves most of the atomic additions.
pub(crate) struct CellCounter<'a> {
    counts: &'a [AtomicU32],
    cell: u32,
    run: u32,
}

impl<'a> CellCounter<'a> {
    pub fn new(counts: &'a [AtomicU32]) -> Self {
        Self { counts, cell: 0, run: 0 }
    }

    /// Counts a particle in a cell.
    #[inline]
    pub fn add(&mut self, cell: u32) {
        if cell != self.cell {
            self.flush();
            self.cell = cell;
        }
        self.run += 1;
    }

    fn flush(&mut self) {
        let run = std::mem::take(&mut self.run);
        if run > 0 {
            self.counts[self.cell as usize].fetch_add(run, Relaxed);
        }
    }
}

impl Drop for CellCounter<'_> {
    fn drop(&mut self) {
        self.flush();
    }
}
