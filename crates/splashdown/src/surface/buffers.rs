//! The buffers of a surface, and the memory that they take.

use glam::{UVec2, Vec4};
use splashdown_gpu::{Buffer, BufferSet, Executor, buffer_set};

use super::SurfaceError;
use super::droplets::Droplet;
use super::params::{Lattice, NODES, ROWS, Status, SurfaceParams};
use crate::cells::Grid;
use crate::marching_cubes;
use crate::scene::{SurfaceKernels, SurfaceSettings};

/// All buffers except those of the particles. The label of each is the name of its field.
#[derive(Clone, Copy, Debug)]
pub(super) struct Buffers {
    pub lattice: Buffer<Lattice>,
    pub cases: Buffer<UVec2>,
    pub kept: Buffer<u32>,
    pub kept_starts: Buffer<u32>,
    pub kept_positions: Buffer<Vec4>,
    pub kept_cell_start: Buffer<u32>,
    pub droplets: Buffer<Droplet>,
    pub droplet_count: Buffer<u32>,
    pub samples: Buffer<Vec4>,
    pub neighbour_moments: Buffer<Vec4>,
    pub kernel_centres: Buffer<Vec4>,
    pub kernel_matrices: Buffer<Vec4>,
    pub local_density: Buffer<f32>,
    pub marks: Buffer<u32>,
    pub mark_starts: Buffer<u32>,
    pub block_slot: Buffer<u32>,
    pub block_list: Buffer<u32>,
    pub field_values: Buffer<f32>,
    pub signs: Buffer<u32>,
    pub rows: Buffer<UVec2>,
    pub vertex_counts: Buffer<u32>,
    pub triangle_counts: Buffer<u32>,
    pub vertex_starts: Buffer<u32>,
    pub triangle_starts: Buffer<u32>,
    pub status: Buffer<Status>,
    pub draw_args: Buffer<u32>,
    pub block_groups: Buffer<u32>,
    pub vertex_groups: Buffer<u32>,
    pub triangle_groups: Buffer<u32>,
    pub vertex_positions: Buffer<Vec4>,
    pub normals: Buffer<Vec4>,
    pub indices: Buffer<u32>,
    pub valences: Buffer<u32>,
    pub one_ring_starts: Buffer<u32>,
    pub one_rings: Buffer<UVec2>,
    pub relaxed: Buffer<Vec4>,
}

impl Buffers {
    /// Creates the buffers, empty except for those of fixed length.
    pub fn new(executor: &mut Executor, lattice: &Lattice) -> Result<Self, SurfaceError> {
        let e = executor;
        Ok(Self {
            lattice: e.create_uniform("lattice", lattice)?,
            cases: e.create_from("cases", &marching_cubes::packed())?,
            kept: e.create("kept", 0)?,
            kept_starts: e.create("kept_starts", 0)?,
            kept_positions: e.create("kept_positions", 0)?,
            kept_cell_start: e.create("kept_cell_start", 0)?,
            droplets: e.create("droplets", 0)?,
            droplet_count: e.create_from("droplet_count", &[0])?,
            samples: e.create("samples", 0)?,
            neighbour_moments: e.create("neighbour_moments", 0)?,
            kernel_centres: e.create("kernel_centres", 0)?,
            kernel_matrices: e.create("kernel_matrices", 0)?,
            local_density: e.create("local_density", 0)?,
            marks: e.create("marks", 0)?,
            mark_starts: e.create("mark_starts", 0)?,
            block_slot: e.create("block_slot", 0)?,
            block_list: e.create("block_list", 0)?,
            field_values: e.create("field_values", 0)?,
            signs: e.create("signs", 0)?,
            rows: e.create("rows", 0)?,
            vertex_counts: e.create("vertex_counts", 0)?,
            triangle_counts: e.create("triangle_counts", 0)?,
            vertex_starts: e.create("vertex_starts", 0)?,
            triangle_starts: e.create("triangle_starts", 0)?,
            status: e.create("status", 1)?,
            draw_args: e.create("draw_args", 5)?,
            block_groups: e.create("block_groups", 3)?,
            vertex_groups: e.create("vertex_groups", 3)?,
            triangle_groups: e.create("triangle_groups", 3)?,
            vertex_positions: e.create("vertex_positions", 0)?,
            normals: e.create("normals", 0)?,
            indices: e.create("indices", 0)?,
            valences: e.create("valences", 0)?,
            one_ring_starts: e.create("one_ring_starts", 0)?,
            one_rings: e.create("one_rings", 0)?,
            relaxed: e.create("relaxed", 0)?,
        })
    }

    /// The buffers by name, for recordings.
    pub fn by_name(&self) -> BufferSet {
        buffer_set!(self =>
            lattice, cases, kept, kept_starts, kept_positions, kept_cell_start, droplets, droplet_count, samples, neighbour_moments, kernel_centres, kernel_matrices, local_density, marks, mark_starts, block_slot, block_list, field_values, signs, rows,
            vertex_counts, triangle_counts, vertex_starts, triangle_starts, status, draw_args, block_groups,
            vertex_groups, triangle_groups, vertex_positions, normals, indices, valences, one_ring_starts, one_rings,
            relaxed,
        )
    }

    /// Resizes every buffer to the capacities of the lattice.
    pub fn resize(
        &mut self,
        e: &mut Executor,
        lattice: &Lattice,
        params: &SurfaceParams,
        cells: u32,
    ) -> Result<(), SurfaceError> {
        macro_rules! resize {
            ($($buffer:ident: $len:expr),* $(,)?) => {
                $(if self.$buffer.len() as usize != $len { e.resize(&mut self.$buffer, $len)?; })*
            };
        }
        let (particles, table) = (lattice.particle_capacity as usize, lattice.block_count as usize);
        let blocks = lattice.block_capacity as usize;
        let (vertices, triangles) = (lattice.vertex_capacity as usize, lattice.triangle_capacity as usize);
        resize! {
            samples: particles, local_density: particles,
            marks: table, mark_starts: table + 1, block_slot: table,
            block_list: blocks, field_values: blocks * NODES, signs: blocks * ROWS, rows: blocks * ROWS,
            vertex_counts: blocks, triangle_counts: blocks, vertex_starts: blocks + 1, triangle_starts: blocks + 1,
            vertex_positions: vertices, normals: vertices, indices: 3 * triangles,
        }
        if params.separates() {
            resize! {
                kept: particles, kept_starts: particles + 1, kept_positions: particles, droplets: particles,
                kept_cell_start: cells as usize + 1,
            }
        }
        let particles = if params.kernels == SurfaceKernels::Anisotropic { particles } else { 0 };
        resize! { neighbour_moments: 3 * particles, kernel_centres: particles, kernel_matrices: 2 * particles }
        let smoothed = params.smoothing_iterations > 0;
        let (vertices, triangles) = if smoothed { (vertices, triangles) } else { (0, 0) };
        resize! { valences: vertices, one_ring_starts: vertices + 1, one_rings: 3 * triangles, relaxed: vertices }
        e.write(self.lattice, std::slice::from_ref(lattice))?;
        Ok(())
    }
}

/// Bytes in the buffers of [`Surface::new`](super::Surface::new), before they grow.
///
/// # Errors
/// As [`Surface::new`](super::Surface::new).
pub(crate) fn forecast(params: &SurfaceParams, grid: &Grid, particles: u32) -> Result<u64, SurfaceError> {
    let lattice = Lattice::new(params, grid, particles, u64::MAX)?;
    let (table, blocks) = (u64::from(lattice.block_count), u64::from(lattice.block_capacity));
    let (vertices, triangles) = (u64::from(lattice.vertex_capacity), u64::from(lattice.triangle_capacity));
    // Samples and local densities; marks, their sums and slots; values, signs and rows of nodes;
    // vertices and normals.
    let whole = u64::from(particles) * 20
        + table * 12
        + blocks * (4 + 4 * NODES as u64 + 12 * ROWS as u64 + 4 * 4)
        + vertices * 32
        + triangles * 12;
    // Valences, one-ring starts, relaxed vertices; one-rings.
    let smoothing = vertices * (4 + 4 + 16) + triangles * 24;
    // Flags, starts, positions that remain, droplets; the first particle of each cell.
    let separated =
        if params.separates() { 56 * u64::from(particles) + 4 * u64::from(grid.cell_count) } else { 0 };
    // Moments, centres and matrices.
    let kernels = u64::from(particles) * if params.kernels == SurfaceKernels::Anisotropic { 96 } else { 0 };
    Ok(whole + kernels + separated + if params.smoothing_iterations > 0 { smoothing } else { 0 })
}

/// The bytes per particle of the largest buffer of the surface that has an entry per particle.
pub(crate) fn largest_per_particle(settings: &SurfaceSettings) -> u64 {
    let droplets = if settings.separates() { size_of::<Droplet>() as u64 } else { 0 };
    // The moments are three vectors.
    let is_anisotropic = settings.enabled && settings.kernels == SurfaceKernels::Anisotropic;
    droplets.max(if is_anisotropic { 48 } else { 0 })
}
