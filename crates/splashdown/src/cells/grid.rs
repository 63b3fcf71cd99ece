//! The uniform grid over the domain.

use glam::Vec3;
use splashdown_gpu::{WgslModule, gpu_struct};

/// The WGSL side: `struct Grid` and `cell_of`.
pub const WGSL: WgslModule = WgslModule { name: "sph/grid", source: include_str!("grid.wgsl") };

gpu_struct! {
    /// Cubic cells over the domain, with a layer of empty ghost cells on every side, so that all 27 cells around any
    /// particle exist. Cell number = (z * size_y + y) * size_x + x, x fastest.
    pub struct Grid {
        /// Lower corner of the first ghost cell in metres.
        origin: Vec3,
        /// Cells per metre. Devices round quotients in different ways. Those that round a difference and a product as IEEE
        /// 754 does find the same cell for a point at a border.
        cells_per_metre: f32,
        /// Cells along x, ghosts included.
        size_x: u32,
        /// Cells along y, ghosts included.
        size_y: u32,
        /// Cells along z, ghosts included.
        size_z: u32,
        /// All cells.
        cell_count: u32,
    }
}

/// Rounding may place two particles that are one support radius apart two cells apart; a slightly larger cell prevents
/// it.
const SLACK: f32 = 1.0001;

impl Grid {
    /// The grid of a box for kernels of this support; `None` if it has more than 2^31 cells.
    pub fn new(min: Vec3, max: Vec3, support_radius: f32) -> Option<Self> {
        let cell_size = support_radius * SLACK;
        let cells = ((max - min).as_dvec3() / f64::from(cell_size)).ceil().max(glam::DVec3::ONE) + 2.0;
        let count = cells.x * cells.y * cells.z;
        (count < f64::from(1_u32 << 31)).then_some(Self {
            origin: min - cell_size,
            cells_per_metre: 1.0 / cell_size,
            size_x: cells.x as u32,
            size_y: cells.y as u32,
            size_z: cells.z as u32,
            cell_count: count as u32,
        })
    }

    /// Edge of a cell in metres, slightly larger than the support radius.
    pub fn cell_size(&self) -> f32 {
        1.0 / self.cells_per_metre
    }

    /// The cell of a point; for points outside, the nearest cell that is not a ghost.
    #[inline]
    pub fn cell_of(&self, x: Vec3) -> u32 {
        let at = (x - self.origin) * self.cells_per_metre;
        let clamp = |value: f32, size: u32| (value as i32).clamp(1, size as i32 - 2) as u32;
        let [i, j, k] = [clamp(at.x, self.size_x), clamp(at.y, self.size_y), clamp(at.z, self.size_z)];
        (k * self.size_y + j) * self.size_x + i
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_has_an_inner_cell() {
        let grid = Grid::new(Vec3::ZERO, Vec3::new(1.0, 0.55, 0.3), 0.1).unwrap();
        assert_eq!(grid.cell_count, grid.size_x * grid.size_y * grid.size_z);
        for x in [Vec3::ZERO, Vec3::new(1.0, 0.55, 0.3), Vec3::splat(-7.0), Vec3::splat(1e30), Vec3::NAN] {
            let cell = grid.cell_of(x);
            let (i, j) = (cell % grid.size_x, cell / grid.size_x % grid.size_y);
            assert!(i > 0 && i < grid.size_x - 1 && j > 0 && j < grid.size_y - 1, "{x}: {cell}");
        }
        assert_eq!(grid.cell_of(Vec3::new(0.15, 0.0, 0.0)) - grid.cell_of(Vec3::ZERO), 1);
        assert!(Grid::new(Vec3::ZERO, Vec3::splat(1e4), 0.001).is_none());
    }
}
