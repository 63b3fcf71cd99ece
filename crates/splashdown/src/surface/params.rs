//! Parameters of surface reconstruction, and the lattice of nodes derived from them.

use glam::{DVec3, UVec3, Vec3};
use splashdown_gpu::gpu_struct;

use super::anisotropy::{self, MAX_SHIFT, MAX_STRETCH};
use super::droplets::{LINK, MAX_BLOB};
use super::{SurfaceError, Walls};
use crate::cells::Grid;
use crate::scene::{SurfaceKernels, SurfaceSettings};

/// Nodes along the side of a block.
pub(crate) const SIDE: u32 = 8;
/// Rows of eight nodes along x in a block.
pub(crate) const ROWS: usize = (SIDE * SIDE) as usize;
/// Nodes in a block.
pub(crate) const NODES: usize = ROWS * SIDE as usize;
/// In the table of blocks: the block is not marked.
pub(crate) const NONE: u32 = u32::MAX;
/// Largest number of triangles: their three indices each are counted in 32 bits.
pub(crate) const MAX_TRIANGLES: u32 = u32::MAX / 3;
/// Largest number of blocks in the dense table on any device: 64 Mi, 256 MiB for each of its three
/// arrays.
const MAX_BLOCKS: u64 = 1 << 26;

/// Shape and resolution of a surface. Lengths in m.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SurfaceParams {
    /// Distance of particles on the initial lattice; it determines the initial capacity of the
    /// mesh.
    pub particle_spacing: f32,
    /// Distance at which the kernel becomes zero; usually 2 spacings.
    pub support_radius: f32,
    /// The kernels of the field.
    pub kernels: SurfaceKernels,
    /// Edge length of a marching-cubes cell; usually 0.5 spacings.
    pub cell_size: f32,
    /// Value of the colour field at the surface. The field is about 1 inside the fluid and 0
    /// outside. Usually 0.6.
    pub iso_level: f32,
    /// Iterations of weighted Laplacian smoothing. 0 keeps the vertices of marching cubes; 15 to 25
    /// remove the bumps of the particles.
    pub smoothing_iterations: u32,
    /// Particles in blobs of fewer than this many leave the surface, see [`isolated`](super::isolated); at most
    /// [`MAX_BLOB`](super::MAX_BLOB). 0 or 1: none of them.
    pub min_blob: u32,
    /// Particles with fewer than this many others within 0.9 support radii leave the surface; at most
    /// [`MAX_BLOB`](super::MAX_BLOB). 0: none of them.
    pub min_neighbours: u32,
    /// Closed sides at which the mesh ends; [`Walls::NONE`] without.
    pub walls: Walls,
}

impl SurfaceParams {
    /// Default values for a particle spacing: a support radius of 2 spacings, cells of half a
    /// spacing, an iso level of 0.6, no smoothing; no particles leave the surface.
    pub fn new(particle_spacing: f32) -> Self {
        Self {
            particle_spacing,
            support_radius: 2.0 * particle_spacing,
            kernels: SurfaceKernels::Isotropic,
            cell_size: 0.5 * particle_spacing,
            iso_level: 0.6,
            smoothing_iterations: 0,
            min_blob: 0,
            min_neighbours: 0,
            walls: Walls::NONE,
        }
    }

    /// The settings of a scene. Its surface ends at the [closed sides](Walls::of_domain) of its domain.
    pub fn of_scene(settings: &SurfaceSettings, particle_spacing: f32, walls: Walls) -> Self {
        Self {
            particle_spacing,
            support_radius: settings.support_ratio * particle_spacing,
            kernels: settings.kernels,
            cell_size: settings.cell_size,
            iso_level: settings.iso_level,
            smoothing_iterations: settings.smoothing_iterations,
            min_blob: settings.min_blob,
            min_neighbours: settings.min_neighbours,
            walls,
        }
    }

    /// Whether isolated particles leave the surface.
    pub fn separates(&self) -> bool {
        self.min_blob > 1 || self.min_neighbours > 0
    }

    /// Validates the values.
    ///
    /// # Errors
    /// [`SurfaceError::Parameter`] for the first invalid value.
    pub fn check(&self) -> Result<(), SurfaceError> {
        let lengths = [
            ("particle_spacing", self.particle_spacing),
            ("support_radius", self.support_radius),
            ("cell_size", self.cell_size),
        ];
        for (name, given) in lengths {
            // Squares and reciprocals of lengths outside this range overflow or underflow.
            if !(1e-12..=1e12).contains(&given) {
                return Err(SurfaceError::Parameter {
                    name,
                    given,
                    allowed: "a length between 1e-12 and 1e12 m",
                });
            }
        }
        // At 0 there is no surface.
        if !(1e-3..=1e3).contains(&self.iso_level) {
            let (name, given) = ("iso_level", self.iso_level);
            return Err(SurfaceError::Parameter { name, given, allowed: "between 0.001 and 1000" });
        }
        for (name, given) in [("min_blob", self.min_blob), ("min_neighbours", self.min_neighbours)] {
            if given > MAX_BLOB {
                return Err(SurfaceError::Parameter { name, given: given as f32, allowed: "at most 32" });
            }
        }
        Ok(())
    }
}

/// The largest coordinate at which an `f32` has three bits for the position within a cell.
pub(crate) fn farthest(cell_size: f32) -> f32 {
    cell_size * (1 << 21) as f32
}

gpu_struct! {
    /// The nodes at which the field is evaluated, in blocks of 8x8x8, and the capacities. Mirrors
    /// `Lattice` in `lattice.wgsl`.
    pub(crate) struct Lattice {
        /// Position of node (0, 0, 0), a multiple of the cell size.
        origin: Vec3,
        /// Distance of nodes.
        cell_size: f32,
        /// Blocks along each axis.
        blocks_x: u32,
        blocks_y: u32,
        blocks_z: u32,
        /// Product of the three: the length of the dense table of blocks.
        block_count: u32,
        support_radius: f32,
        /// 1 / support_radius
        inverse_support: f32,
        /// 1 / cell_size
        inverse_cell: f32,
        iso_level: f32,
        /// Capacity of the field in blocks.
        block_capacity: u32,
        vertex_capacity: u32,
        triangle_capacity: u32,
        particle_capacity: u32,
        /// Corners of the closed sides in m, see [`Walls`].
        wall_low: Vec3,
        /// Distance from a wall in m within which a node counts as outside.
        wall_margin: f32,
        wall_high: Vec3,
        /// Largest distance in m at which a sample contributes to the field.
        reach: f32,
        /// The layers of nodes that are moved to the walls, see [`Lattice::coordinate`].
        wall_low_nodes: UVec3,
        /// Largest distance in m from the position by which a particle is sorted to a node that its sample contributes to.
        search_reach: f32,
        wall_high_nodes: UVec3,
        /// Number of neighbours in the bulk, as [`anisotropy`](super::anisotropy) counts them.
        bulk_number: f32,
        /// Blobs of fewer particles leave the surface.
        min_blob: u32,
        /// Particles with fewer neighbours leave the surface.
        min_neighbours: u32,
        /// Square of the largest distance of linked particles in m^2.
        link_square: f32,
        /// Size of the anisotropic kernel of a lone particle, see [`lone_size`](super::anisotropy::lone_size).
        lone_size: f32,
    }
}

/// [`Lattice::wall_margin`] in cells. A vertex on a wall is at least this far from the inner end of its edge.
const WALL_MARGIN: f32 = 1e-3;
/// Distance in wall margins of the layer of nodes that is moved to a wall.
pub(crate) const LAYER_MARGINS: f32 = 2.0;

impl Lattice {
    /// The lattice over everything within reach of particles in `grid`, with capacities estimated
    /// from their number.
    pub fn new(
        params: &SurfaceParams,
        grid: &Grid,
        particle_capacity: u32,
        largest_table: u64,
    ) -> Result<Self, SurfaceError> {
        params.check()?;
        if grid.cube_size() < params.support_radius {
            let (cell_size, support_radius) = (grid.cube_size(), params.support_radius);
            return Err(SurfaceError::GridTooFine { cell_size, support_radius });
        }
        let cell = f64::from(params.cell_size);
        let [reach, search_reach] = match params.kernels {
            SurfaceKernels::Isotropic => [params.support_radius; 2],
            SurfaceKernels::Anisotropic => {
                [MAX_STRETCH, MAX_STRETCH + MAX_SHIFT].map(|ratio| ratio * params.support_radius)
            }
        };
        // Part of the reach beyond a ghost cube.
        let beyond = f64::from(search_reach - params.support_radius);
        let low = grid.origin.as_dvec3() - beyond;
        let extent = 2.0 * beyond + grid.size().as_dvec3() / grid.cells_per_metre.as_dvec3();
        let cell_size = params.cell_size;
        let most = low.abs().max((low + extent).abs()).max_element();
        // The layers of nodes at walls need more bits within a cell.
        let allowed = farthest(cell_size) / if params.walls == Walls::NONE { 1.0 } else { 16.0 };
        if most > f64::from(allowed) {
            return Err(SurfaceError::TooFar { farthest: most as f32, cell_size, allowed });
        }
        // The grid has a ghost cell, at least as wide as the support, on every side. Two more nodes
        // are for the cells around the outermost nodes and for rounding.
        let first = (low / cell).floor() - 2.0;
        let nodes = ((low + extent) / cell).ceil() + 3.0 - first;
        let blocks: DVec3 = (nodes / f64::from(SIDE)).ceil();
        let count = blocks.x * blocks.y * blocks.z;
        let allowed = MAX_BLOCKS.min(largest_table / 4);
        if count > allowed as f64 {
            let size = extent.as_vec3().to_array();
            return Err(SurfaceError::TooLarge { size, cell_size: params.cell_size, blocks: count, allowed });
        }
        // The layers of nodes nearest to the walls; an index that no node has without a wall, and for walls far outside.
        let layers = |wall: Vec3| {
            let nearest = (wall.as_dvec3() / cell - first).round();
            let index = |n: f64| if (0.0..1e9).contains(&n) { n as u32 } else { 1 << 31 };
            UVec3::from_array(nearest.to_array().map(index))
        };
        let mut lattice = Self {
            origin: (first * cell).as_vec3(),
            cell_size: params.cell_size,
            blocks_x: blocks.x as u32,
            blocks_y: blocks.y as u32,
            blocks_z: blocks.z as u32,
            block_count: count as u32,
            support_radius: params.support_radius,
            inverse_support: 1.0 / params.support_radius,
            inverse_cell: 1.0 / params.cell_size,
            iso_level: params.iso_level,
            block_capacity: 1,
            vertex_capacity: 1,
            triangle_capacity: 1,
            particle_capacity,
            wall_low: params.walls.low,
            // At least two steps of the coordinates, far from the origin.
            wall_margin: (WALL_MARGIN * params.cell_size).max(2.0 * f32::EPSILON * most as f32),
            wall_high: params.walls.high,
            reach,
            wall_low_nodes: layers(params.walls.low),
            search_reach,
            wall_high_nodes: layers(params.walls.high),
            bulk_number: anisotropy::bulk_number(params),
            min_blob: params.min_blob,
            min_neighbours: params.min_neighbours,
            link_square: (LINK * params.support_radius).powi(2),
            lone_size: anisotropy::lone_size(params),
        };
        lattice.estimate(params);
        Ok(lattice)
    }

    /// Estimates the capacities. A splash of 64,000 particles has 0.9 vertices per particle with
    /// cells of half a spacing and 3.6 with cells of a quarter, and twice as many triangles; it has
    /// 1,874 and 12,903 blocks, while 1,000 and 8,000 blocks have the volume of the fluid. Spray
    /// and thin sheets need more of both: the extraction is then repeated once.
    fn estimate(&mut self, params: &SurfaceParams) {
        let particles = f64::from(self.particle_capacity);
        let cells = f64::from(params.particle_spacing / params.cell_size);
        let vertices = (1.5 * particles * (cells / 2.0).powi(2) + 4096.0).min(f64::from(1 << 30));
        let bulk = particles * (cells / f64::from(SIDE)).powi(3);
        let skin = particles * (cells / f64::from(SIDE)).powi(2);
        self.block_capacity = (1.5 * bulk + 0.25 * skin + 512.0).min(f64::from(self.block_count)) as u32;
        self.vertex_capacity = vertices as u32;
        self.triangle_capacity = (2 * self.vertex_capacity).min(MAX_TRIANGLES);
    }

    /// Coordinates of a block, in blocks.
    pub fn block_place(&self, block: u32) -> [i32; 3] {
        let (x, rest) = (block % self.blocks_x, block / self.blocks_x);
        [x, rest % self.blocks_y, rest / self.blocks_y].map(|place| place as i32)
    }

    /// The index of a block in the dense table, if the coordinates are inside the lattice.
    pub fn block_at(&self, place: [i32; 3]) -> Option<usize> {
        let [x, y, z] = place.map(|p| p as u32);
        // Negative coordinates wrap to large numbers.
        let within = x < self.blocks_x && y < self.blocks_y && z < self.blocks_z;
        within
            .then(|| (z as usize * self.blocks_y as usize + y as usize) * self.blocks_x as usize + x as usize)
    }

    /// The walls.
    pub fn walls(&self) -> Walls {
        Walls { low: self.wall_low, high: self.wall_high }
    }

    /// The coordinate of a node along an axis: a multiple of the cell size, except that the layer of nodes nearest to a wall
    /// lies immediately in front of it. The cells of the surface then fill the edges of a box. On a regular lattice they
    /// cut every edge off, by up to a cell.
    pub fn coordinate(&self, axis: usize, node: u32) -> f32 {
        if node == self.wall_low_nodes[axis] {
            self.wall_low[axis] + LAYER_MARGINS * self.wall_margin
        } else if node == self.wall_high_nodes[axis] {
            self.wall_high[axis] - LAYER_MARGINS * self.wall_margin
        } else {
            self.origin[axis] + self.cell_size * node as f32
        }
    }
}

gpu_struct! {
    /// The size of the mesh, written on the device; one element. Mirrors `Status` in `status.wgsl`.
    ///
    /// The required numbers can exceed the capacities. The mesh then has holes until
    /// [`Surface::grow`](super::Surface::grow) has enlarged the buffers and the recording has run
    /// again.
    pub struct Status {
        /// Number of blocks with data.
        blocks: u32,
        /// Number of blocks within reach of particles.
        blocks_needed: u32,
        /// Number of vertices written.
        vertices: u32,
        /// Number of vertices of the blocks with data.
        vertices_needed: u32,
        /// Number of triangles written.
        triangles: u32,
        /// Number of triangles of the blocks with data.
        triangles_needed: u32,
    }
}

impl Status {
    /// True if a capacity was exceeded.
    pub fn overflowed(&self) -> bool {
        self.blocks_needed > self.blocks
            || self.vertices_needed > self.vertices
            || self.triangles_needed > self.triangles
    }
}
