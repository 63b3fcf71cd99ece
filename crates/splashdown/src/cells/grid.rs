//! The uniform grid over the domain.

use std::ops::Range;

use glam::{DVec3, UVec3, Vec3};
use splashdown_gpu::{WgslModule, gpu_struct};

/// The WGSL side: `struct Grid`, `coordinates` and `cell_of`.
pub const WGSL: WgslModule = WgslModule { name: "sph/grid", source: include_str!("grid.wgsl") };

gpu_struct! {
    /// Cubes over the domain, with a layer of empty ghost cubes on every side, so that all 27 cubes around any particle
    /// exist. A cube is divided along x into slices, which are the cells. Cell number = (z * size_y + y) * size_x + x, x
    /// fastest, so that the cells of a cube follow one another.
    ///
    /// With cells that are short along x, the particles near a point are a small part of a row of cells: with four slices
    /// and a support radius of two spacings a warp of a GPU tests about 170 candidates instead of 216.
    pub struct Grid {
        /// Lower corner of the first ghost cube in metres.
        origin: Vec3,
        /// All cells.
        cell_count: u32,
        /// Cells per metre along each axis. Devices round quotients in different ways. Those that round a difference and a
        /// product as IEEE 754 does find the same cell for a point at a border.
        cells_per_metre: Vec3,
        /// Cells along x, ghosts included.
        size_x: u32,
        /// Cells along y, ghosts included.
        size_y: u32,
        /// Cells along z, ghosts included.
        size_z: u32,
        /// Cells of a cube.
        slices: u32,
        unused: u32,
    }
}

/// Rounding may place two particles that are one support radius apart two cubes apart; a slightly larger cube prevents
/// it.
const SLACK: f32 = 1.0001;

/// The smallest number of cells that is too large.
const CELL_LIMIT: f64 = (1_u32 << 31) as f64;

/// The largest number of cells per particle for which cubes are divided.
const CELLS_PER_PARTICLE: u32 = 8;
/// The number of particles that counts if there are fewer.
const LEAST_PARTICLES: u32 = 1 << 12;

impl Grid {
    /// The grid of a box for kernels of this support, whose cells are cubes; `None` if it has 2^31 or more.
    pub fn new(min: Vec3, max: Vec3, support_radius: f32) -> Option<Self> {
        let cube = support_radius * SLACK;
        let cubes = ((max - min).as_dvec3() / f64::from(cube)).ceil().max(DVec3::ONE) + 2.0;
        (cubes.element_product() < CELL_LIMIT).then_some(Self {
            origin: min - cube,
            cell_count: cubes.element_product() as u32,
            cells_per_metre: Vec3::splat(1.0 / cube),
            size_x: cubes.x as u32,
            size_y: cubes.y as u32,
            size_z: cubes.z as u32,
            slices: 1,
            unused: 0,
        })
    }

    /// A grid of the same cubes, with four slices each for a GPU that binds at most `largest_buffer` bytes, or fewer where there
    /// would be more than eight cells per particle, or where [`cell_counts`](super::Cells::cell_counts) would not fit.
    #[must_use]
    pub fn for_gpu(self, particles: u32, largest_buffer: u64) -> Self {
        let most = u64::from(particles.max(LEAST_PARTICLES)) * u64::from(CELLS_PER_PARTICLE);
        let fits = |slices: &u32| {
            let cells = u64::from(self.cell_count / self.slices) * u64::from(*slices);
            cells <= most && 4 * (cells + 2 + u64::from(particles)) <= largest_buffer
        };
        [4, 2].into_iter().find(fits).and_then(|slices| self.with_slices(slices)).unwrap_or(self)
    }

    /// A grid of the same cubes with this many slices each; `None` if it has 2^31 cells or more.
    pub fn with_slices(self, slices: u32) -> Option<Self> {
        let cubes = self.cell_count / self.slices;
        let columns = self.size_x / self.slices;
        (f64::from(cubes) * f64::from(slices) < CELL_LIMIT).then(|| Self {
            cell_count: cubes * slices,
            cells_per_metre: self.cells_per_metre.with_x(self.cells_per_metre.y * slices as f32),
            size_x: columns * slices,
            slices,
            ..self
        })
    }

    /// Edge of a cube in metres, slightly larger than the support radius.
    pub fn cube_size(&self) -> f32 {
        1.0 / self.cells_per_metre.y
    }

    /// The number of cells along each axis, ghosts included.
    pub fn size(&self) -> UVec3 {
        UVec3::new(self.size_x, self.size_y, self.size_z)
    }

    /// The position of a point in cells.
    #[inline]
    pub fn coordinates(&self, x: Vec3) -> Vec3 {
        (x - self.origin) * self.cells_per_metre
    }

    /// The cell of a point; for points outside, the nearest cell that is not a ghost.
    #[inline]
    pub fn cell_of(&self, x: Vec3) -> u32 {
        let at = self.coordinates(x);
        let clamp = |value: f32, size: u32, ghosts: u32| {
            (value as i32).clamp(ghosts as i32, (size - ghosts - 1) as i32) as u32
        };
        let i = clamp(at.x, self.size_x, self.slices);
        let [j, k] = [clamp(at.y, self.size_y, 1), clamp(at.z, self.size_z, 1)];
        (k * self.size_y + j) * self.size_x + i
    }

    /// The first cell of the cube of a point.
    #[inline]
    pub fn cube_of(&self, x: Vec3) -> u32 {
        let cell = self.cell_of(x);
        cell - cell % self.slices
    }

    /// The particles of the cube that begins with a cell and of its 26 neighbours: nine rows of three cubes each. For
    /// `cell_start` see [`Cells::cell_start`](super::Cells::cell_start).
    #[inline(always)]
    pub fn runs_around(&self, cell_start: &[u32], cube: u32) -> [Range<usize>; 9] {
        let (width, plane) = (self.size_x as usize, (self.size_x * self.size_y) as usize);
        let slices = self.slices as usize;
        let first = cube as usize - plane - width - slices;
        std::array::from_fn(|row| {
            let begin = first + row / 3 * plane + row % 3 * width;
            cell_start[begin] as usize..cell_start[begin + 3 * slices] as usize
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_has_an_inner_cell() {
        for slices in [1, 2, 4] {
            let grid = Grid::new(Vec3::ZERO, Vec3::new(1.0, 0.55, 0.3), 0.1).unwrap();
            let grid = grid.with_slices(slices).unwrap();
            assert_eq!(grid.cell_count, grid.size().element_product());
            for x in [Vec3::ZERO, Vec3::new(1.0, 0.55, 0.3), Vec3::splat(-7.0), Vec3::splat(1e30), Vec3::NAN]
            {
                let cell = grid.cell_of(x);
                let (i, j) = (cell % grid.size_x, cell / grid.size_x % grid.size_y);
                assert!(i >= slices && i < grid.size_x - slices, "{x}: {cell}");
                assert!(j > 0 && j < grid.size_y - 1, "{x}: {cell}");
            }
            let points = [Vec3::ZERO, Vec3::new(0.15, 0.0, 0.0)];
            let [[first, second], cubes] = [points.map(|x| grid.cell_of(x)), points.map(|x| grid.cube_of(x))];
            assert_eq!(second - first, [1, 2, 5][slices as usize / 2]);
            assert_eq!(cubes, [first, first + slices]);
        }
        assert!(Grid::new(Vec3::ZERO, Vec3::splat(1e4), 0.001).is_none());
    }

    #[test]
    fn cubes_are_divided_where_there_are_enough_particles() {
        let slices = |size, particles| {
            let cubes = Grid::new(Vec3::ZERO, Vec3::splat(size), 1.0).unwrap();
            let divided = cubes.for_gpu(particles, u64::MAX);
            assert_eq!(divided, cubes.with_slices(divided.slices).unwrap());
            divided.slices
        };
        assert_eq!(slices(9.5, 0), 4, "small grids are always divided");
        // 100^3 cubes with the ghosts.
        assert_eq!([500_000, 499_999, 250_000, 249_999].map(|n| slices(97.5, n)), [4, 2, 2, 1]);
        // Buffers of the cells and of a million particles.
        let cubes = Grid::new(Vec3::ZERO, Vec3::splat(97.5), 1.0).unwrap();
        let slices = |megabytes: u64| cubes.for_gpu(1_000_000, megabytes * 1_000_000).slices;
        assert_eq!([21, 19, 13, 11].map(slices), [4, 2, 2, 1]);
    }
}
