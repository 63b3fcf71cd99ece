//! The particles near a box, copied side by side for the processor's wide lanes.
//!
//! The particles of a box of cells lie in a few contiguous ranges of the sorted arrays, one per row of cells. Copying them once into short
//! columns, padded to whole vectors, makes the loops that visit them thousands of times branchless; they stay in the first-level cache.

use glam::{Vec3, Vec4};

use crate::cells::Grid;

/// Particles a loop takes at a time.
pub(crate) const LANES: usize = 8;
/// So far away that nothing reaches it, and its square is still a number.
const FAR: f32 = 1e18;

/// Particles in columns. The columns have equal length, a multiple of [`LANES`]; padding lies far away and weighs nothing.
#[derive(Default)]
pub(crate) struct Gathered {
    pub x: Vec<f32>,
    pub y: Vec<f32>,
    pub z: Vec<f32>,
    /// The fourth component of what was gathered.
    pub w: Vec<f32>,
    /// A further value per particle, where asked for.
    pub extra: Vec<f32>,
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
    /// Copies the particles of the cells that the box touches, in the order of the sorted arrays; those outside the box itself are
    /// left out. `extra`, unless empty, is gathered too.
    pub fn fill(
        &mut self,
        grid: &Grid,
        cell_start: &[u32],
        values: &[Vec4],
        extra: &[f32],
        low: Vec3,
        high: Vec3,
    ) {
        self.clear();
        let Some((first, last)) = cell_range(grid, low, high) else { return };
        let limit = values.len() as u32;
        for z in first[2]..=last[2] {
            for y in first[1]..=last[1] {
                let row = (z as usize * grid.size_y as usize + y as usize) * grid.size_x as usize;
                let start = cell_start[row + first[0] as usize].min(limit) as usize;
                let end = cell_start[row + last[0] as usize + 1].min(limit) as usize;
                for (i, value) in values[..end].iter().enumerate().skip(start) {
                    let p = value.truncate();
                    if p.cmpge(low).all() && p.cmple(high).all() {
                        self.push(value, extra.get(i).copied().unwrap_or_default());
                    }
                }
            }
        }
        self.pad();
    }

    fn clear(&mut self) {
        for column in [&mut self.x, &mut self.y, &mut self.z, &mut self.w, &mut self.extra] {
            column.clear();
        }
    }

    fn push(&mut self, value: &Vec4, extra: f32) {
        self.x.push(value.x);
        self.y.push(value.y);
        self.z.push(value.z);
        self.w.push(value.w);
        self.extra.push(extra);
    }

    fn pad(&mut self) {
        while !self.x.len().is_multiple_of(LANES) {
            self.push(&Vec4::new(FAR, FAR, FAR, 0.0), 0.0);
        }
    }
}

/// Defines a function twice: as it is, and compiled for AVX2, chosen when it runs. No fused multiply-add is used, so both give
/// the same bits.
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
