//! How the CPU visits neighbours: row by row of the grid, over gathered columns.
//!
//! *How it works.* The particles of an x-row of cells are contiguous. For such a row its candidates are gathered once
//! into columns (one array per quantity), ordered by x-cell: all particles of the nine cells at x = 0, then at x = 1,
//! and so on. The candidates of a particle in cell x are then one contiguous run, from the beginning of x-cell x - 1 to
//! the end of x-cell x + 1, and a loop over 8 or 16 of them at a time needs no branch and no tail: what lies behind the
//! run is at least one support away and contributes zero, and the end is padded with particles far away.
//!
//! *Why not* a list of neighbours: at two spacings of support it costs more to write and read than the distance tests it
//! saves. *Why not* each pair once: the sums would depend on the order of the threads.

use rayon::prelude::*;

use crate::cells::Grid;

/// Most candidates per turn of an inner loop: 16 where few sums are kept, 8 where more would not fit the registers.
const MOST_LANES: usize = 16;
/// Coordinate of the padding: far from everything, and its square is finite.
const FAR: f32 = 1e15;

/// The candidates of one x-row in `F` columns; the first three are the position.
pub(crate) struct Window<const F: usize> {
    columns: [Vec<f32>; F],
    /// Where each x-cell begins in the columns.
    starts: Vec<u32>,
}

impl<const F: usize> Window<F> {
    fn new() -> Self {
        Self { columns: std::array::from_fn(|_| Vec::new()), starts: Vec::new() }
    }

    /// Gathers the candidates of the row whose first cell is `row`.
    #[inline(always)]
    pub fn gather(&mut self, grid: &Grid, cell_start: &[u32], row: usize, load: impl Fn(usize) -> [f32; F]) {
        let (width, plane) = (grid.size_x as usize, (grid.size_x * grid.size_y) as usize);
        self.columns.iter_mut().for_each(Vec::clear);
        self.starts.clear();
        for x in 0..width {
            self.starts.push(self.columns[0].len() as u32);
            let cell = row + x;
            // Columns that no particle of this row looks at stay empty.
            let (left, right) = (cell.max(row + 1) - 1, (cell + 1).min(row + width - 1));
            if cell_start[left] == cell_start[right + 1] {
                continue;
            }
            for side in [cell - plane, cell, cell + plane] {
                for neighbour in [side - width, side, side + width] {
                    for j in cell_start[neighbour] as usize..cell_start[neighbour + 1] as usize {
                        for (column, value) in self.columns.iter_mut().zip(load(j)) {
                            column.push(value);
                        }
                    }
                }
            }
        }
        self.starts.push(self.columns[0].len() as u32);
        for (f, column) in self.columns.iter_mut().enumerate() {
            column.extend_from_slice(&[if f < 3 { FAR } else { 0.0 }; MOST_LANES]);
        }
    }

    /// The candidates of the particles in the x-cell `x`, in columns of whole lanes.
    #[inline(always)]
    pub fn candidates<const LANES: usize>(&self, x: usize) -> [&[[f32; LANES]]; F] {
        let (begin, end) = (self.starts[x - 1] as usize, self.starts[x + 2] as usize);
        let end = begin + (end - begin).next_multiple_of(LANES);
        std::array::from_fn(|f| self.columns[f][begin..end].as_chunks().0)
    }
}

/// Visits every row of cells that holds particles, in parallel: `visit(window, first cell, places, outputs)` fills the
/// outputs of the row's particles, which lie at `places` of the sorted arrays.
///
/// A row's result depends on nothing but its input, so that the number of threads changes no bit.
pub(crate) fn for_each<const F: usize, T: Send>(
    grid: &Grid,
    cell_start: &[u32],
    mut outputs: &mut [T],
    visit: impl Fn(&mut Window<F>, usize, std::ops::Range<usize>, &mut [T]) + Sync,
) {
    let width = grid.size_x as usize;
    let mut tasks = Vec::new();
    for row in (0..grid.cell_count as usize).step_by(width) {
        let (begin, end) = (cell_start[row] as usize, cell_start[row + width] as usize);
        if begin == end {
            continue;
        }
        let (piece, rest) = std::mem::take(&mut outputs).split_at_mut(end - begin);
        outputs = rest;
        tasks.push((row, begin..end, piece));
    }
    tasks.into_par_iter().with_max_len(8).for_each_init(Window::new, |window, (row, places, piece)| {
        visit(window, row, places, piece);
    });
}

/// The x-cells of a row that hold particles, with the places of these.
#[inline(always)]
pub(crate) fn occupied<'a>(
    grid: &Grid,
    cell_start: &'a [u32],
    row: usize,
) -> impl Iterator<Item = (usize, std::ops::Range<usize>)> + use<'a> {
    let starts = &cell_start[row..=row + grid.size_x as usize];
    starts
        .windows(2)
        .enumerate()
        .filter(|(_, bounds)| bounds[0] < bounds[1])
        .map(|(x, bounds)| (x, bounds[0] as usize..bounds[1] as usize))
}

/// The sum of lanes, always in the same order: halves are folded onto each other.
#[inline(always)]
pub(crate) fn sum<const LANES: usize>(mut lanes: [f32; LANES]) -> f32 {
    let mut width = LANES;
    while width > 1 {
        width /= 2;
        for l in 0..width {
            lanes[l] += lanes[l + width];
        }
    }
    lanes[0]
}
