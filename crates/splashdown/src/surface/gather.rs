//! The particles near a box, copied side by side for the processor's wide lanes.
//!
//! The particles of a box of cells lie in a few contiguous ranges of the sorted arrays, one per row of cells.
//! Copying them once into short columns, padded to whole vectors, makes the loops that visit them thousands
//! of times branchless; they stay in the first-level cache.

use glam::{Vec3, Vec4};

use crate::cells::Grid;

/// Particles a loop takes at a time.
pub(crate) const LANES: usize = 8;
/// So far away that nothing reaches it, and its square is still a number.
const FAR: f32 = 1e18;

/// Particles in columns of equal length, a multiple of [`LANES`]; padding lies far away and weighs nothing.
#[derive(Default)]
pub(crate) struct Gathered {
    /// x, y, z, the fourth component of what was gathered, and a further value where asked for. Longer than
    /// `len` after a fuller neighbourhood.
    columns: [Vec<f32>; 5],
    len: usize,
}

/// The columns of what was gathered.
#[derive(Clone, Copy)]
pub(crate) struct Columns<'a> {
    pub x: &'a [f32],
    pub y: &'a [f32],
    pub z: &'a [f32],
    pub w: &'a [f32],
    pub extra: &'a [f32],
}

/// The cells that a box touches, both ends included; `None` if it lies outside the grid.
pub(crate) fn cell_range(grid: &Grid, low: Vec3, high: Vec3) -> Option<([u32; 3], [u32; 3])> {
    let size = [grid.size_x, grid.size_y, grid.size_z];
    let inverse = 1.0 / grid.cell_size;
    let (low, high) = (((low - grid.origin) * inverse).floor(), ((high - grid.origin) * inverse).floor());
    if (0..3).any(|axis| high[axis] < 0.0 || low[axis] >= size[axis] as f32 || size[axis] == 0) {
        return None;
    }
    // Casts saturate: below zero becomes zero.
    let first = std::array::from_fn(|axis| low[axis] as u32);
    let last = std::array::from_fn(|axis| (high[axis] as u32).min(size[axis] - 1));
    Some((first, last))
}

impl Gathered {
    /// Copies the particles of the cells that the box touches, in the order of the sorted arrays; those
    /// outside the box itself are left out. `extra`, unless empty, is gathered too.
    pub fn fill(
        &mut self,
        grid: &Grid,
        cell_start: &[u32],
        values: &[Vec4],
        extra: &[f32],
        low: Vec3,
        high: Vec3,
    ) {
        self.len = 0;
        if let Some(cells) = cell_range(grid, low, high) {
            self.fill_from(grid, cells, cell_start, values, extra, (low, high));
        }
    }

    /// As [`fill`](Self::fill), from these cells only (first and last along each axis).
    pub fn fill_from(
        &mut self,
        grid: &Grid,
        (first, last): ([u32; 3], [u32; 3]),
        cell_start: &[u32],
        values: &[Vec4],
        extra: &[f32],
        (low, high): (Vec3, Vec3),
    ) {
        let limit = values.len() as u32;
        let ranges =
            (first[2]..=last[2]).flat_map(|z| (first[1]..=last[1]).map(move |y| (y, z))).map(|(y, z)| {
                let row = (z as usize * grid.size_y as usize + y as usize) * grid.size_x as usize;
                let start = cell_start[row + first[0] as usize].min(limit) as usize;
                start..(cell_start[row + last[0] as usize + 1].min(limit) as usize).max(start)
            });
        let most = ranges.clone().map(|range| range.len()).sum::<usize>() + LANES;
        if self.columns[0].len() < most {
            self.columns.iter_mut().for_each(|column| column.resize(most, 0.0));
        }
        let [x, y, z, w, more] = self.columns.each_mut().map(|column| &mut column[..most]);
        let (low, high) = (low.extend(0.0), high.extend(0.0));
        let mut len = 0;
        for range in ranges {
            for (i, value) in range.clone().zip(&values[range]) {
                // Always written, and kept by counting it: no branch to mispredict.
                (x[len], y[len], z[len], w[len]) = (value.x, value.y, value.z, value.w);
                if !extra.is_empty() {
                    more[len] = extra[i];
                }
                let within = value.cmpge(low) & value.cmple(high);
                len += usize::from(within.bitmask() & 7 == 7);
            }
        }
        let padded = len.next_multiple_of(LANES);
        for column in [x, y, z] {
            column[len..padded].fill(FAR);
        }
        for column in [w, more] {
            column[len..padded].fill(0.0);
        }
        self.len = padded;
    }

    /// What was gathered.
    pub fn columns(&self) -> Columns<'_> {
        let [x, y, z, w, extra] = self.columns.each_ref().map(|column| &column[..self.len]);
        Columns { x, y, z, w, extra }
    }
}

/// Defines a function twice: as it is, and compiled for AVX2, chosen when it runs. No fused multiply-add is
/// used, so both give the same bits.
macro_rules! dispatched {
    ($(#[$meta:meta])* $vis:vis fn $name:ident($($arg:ident: $ty:ty),* $(,)?) $(-> $out:ty)? $body:block) => {
        $(#[$meta])*
        $vis fn $name($($arg: $ty),*) $(-> $out)? {
            #[inline(always)]
            fn body($($arg: $ty),*) $(-> $out)? $body
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            {
                #[target_feature(enable = "avx2")]
                fn wide($($arg: $ty),*) $(-> $out)? {
                    body($($arg),*)
                }
                if std::arch::is_x86_feature_detected!("avx2") {
                    // SAFETY: the processor was just asked for AVX2, the only requirement of `wide`.
                    return unsafe { wide($($arg),*) };
                }
            }
            body($($arg),*)
        }
    };
}
pub(crate) use dispatched;
