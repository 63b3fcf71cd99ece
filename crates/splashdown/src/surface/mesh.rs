//! Surface extraction: buffers, list of passes, growth of the buffers.

use glam::{UVec2, Vec4};
use splashdown_gpu::scan::Scan;
use splashdown_gpu::{Buffer, Executor, Grid as Work, Recording, block_on};
use splashdown_io::Mesh;

use super::params::{Lattice, MAX_TRIANGLES, NODES, ROWS, Status, SurfaceParams};
use super::{SurfaceError, blocks, field, march, smooth, volume};
use crate::cells::Grid;
use crate::marching_cubes;

/// The particles of a surface, in the buffers of the simulation.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceInput {
    /// Positions in m, sorted by cell; w is ignored.
    pub positions: Buffer<Vec4>,
    /// First particle of every cell, followed by the number of living particles.
    pub cell_start: Buffer<u32>,
    /// The neighbour grid on the device.
    pub grid: Buffer<Grid>,
    /// The same grid on the host.
    pub grid_host: Grid,
    /// Largest number of particles.
    pub particle_capacity: u32,
}

/// Size of a mesh, and statistics of its extraction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct SurfaceStats {
    /// Number of vertices.
    pub vertices: u32,
    /// Number of triangles.
    pub triangles: u32,
    /// Number of blocks of 8x8x8 nodes at which the field was evaluated.
    pub blocks: u32,
    /// Number of repetitions of the extraction because the capacity was too small.
    pub retries: u32,
    /// Number of particles that were skipped because a coordinate was NaN or infinite. Only host
    /// data can contain these.
    pub not_finite: u32,
}

/// Extracts the surface of the particles of a simulation repeatedly, on the device.
///
/// With blocking: call [`extract`](Self::extract), then [`mesh`](Self::mesh) to read the mesh back.
/// Without blocking: [`record`](Self::record) into the recording of a frame, draw with
/// [`draw_args`](Self::draw_args), request [`status`](Self::status) and pass it to
/// [`grow`](Self::grow) when it arrives; if that enlarges the buffers, record again.
#[derive(Debug)]
pub struct Surface {
    params: SurfaceParams,
    input: SurfaceInput,
    lattice: Lattice,
    pub(super) recording: Recording,
    pub(super) b: Buffers,
    mark_scan: Scan,
    block_scan: Scan,
    vertex_scan: Option<Scan>,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Buffers {
    pub lattice: Buffer<Lattice>,
    pub cases: Buffer<UVec2>,
    pub samples: Buffer<Vec4>,
    pub local_density: Buffer<f32>,
    pub marks: Buffer<u32>,
    pub mark_starts: Buffer<u32>,
    pub block_slot: Buffer<u32>,
    pub block_list: Buffer<u32>,
    pub values: Buffer<f32>,
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
    pub vertices: Buffer<Vec4>,
    pub normals: Buffer<Vec4>,
    pub indices: Buffer<u32>,
    pub valences: Buffer<u32>,
    pub one_ring_starts: Buffer<u32>,
    pub one_rings: Buffer<UVec2>,
    pub relaxed: Buffer<Vec4>,
}

impl Buffers {
    /// Creates the buffers, empty except for those of fixed length.
    fn new(executor: &mut Executor, lattice: &Lattice) -> Result<Self, SurfaceError> {
        let e = executor;
        Ok(Self {
            lattice: e.create_uniform("surface lattice", lattice)?,
            cases: e.create_from("surface cases", &marching_cubes::packed())?,
            samples: e.create("surface samples", 0)?,
            local_density: e.create("surface local densities", 0)?,
            marks: e.create("surface marks", 0)?,
            mark_starts: e.create("surface mark starts", 0)?,
            block_slot: e.create("surface block slots", 0)?,
            block_list: e.create("surface block list", 0)?,
            values: e.create("surface field", 0)?,
            signs: e.create("surface signs", 0)?,
            rows: e.create("surface rows", 0)?,
            vertex_counts: e.create("surface vertex counts", 0)?,
            triangle_counts: e.create("surface triangle counts", 0)?,
            vertex_starts: e.create("surface vertex starts", 0)?,
            triangle_starts: e.create("surface triangle starts", 0)?,
            status: e.create("surface status", 1)?,
            draw_args: e.create("surface draw arguments", 5)?,
            block_groups: e.create("surface block groups", 3)?,
            vertex_groups: e.create("surface vertex groups", 3)?,
            triangle_groups: e.create("surface triangle groups", 3)?,
            vertices: e.create("surface vertices", 0)?,
            normals: e.create("surface normals", 0)?,
            indices: e.create("surface indices", 0)?,
            valences: e.create("surface valences", 0)?,
            one_ring_starts: e.create("surface one-ring starts", 0)?,
            one_rings: e.create("surface one-rings", 0)?,
            relaxed: e.create("surface relaxed vertices", 0)?,
        })
    }

    /// Resizes every buffer to the capacities of the lattice.
    fn resize(&mut self, e: &mut Executor, lattice: &Lattice, smoothed: bool) -> Result<(), SurfaceError> {
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
            block_list: blocks, values: blocks * NODES, signs: blocks * ROWS, rows: blocks * ROWS,
            vertex_counts: blocks, triangle_counts: blocks, vertex_starts: blocks + 1, triangle_starts: blocks + 1,
            vertices: vertices, normals: vertices, indices: 3 * triangles,
        }
        let (vertices, triangles) = if smoothed { (vertices, triangles) } else { (0, 0) };
        resize! { valences: vertices, one_ring_starts: vertices + 1, one_rings: 3 * triangles, relaxed: vertices }
        e.write(self.lattice, std::slice::from_ref(lattice))?;
        Ok(())
    }
}

/// Bytes in the buffers of [`Surface::new`], before they grow.
///
/// # Errors
/// As [`Surface::new`].
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
    Ok(whole + if params.smoothing_iterations > 0 { smoothing } else { 0 })
}

impl Surface {
    /// The largest value of the field at the nodes of the last extraction.
    pub(super) fn highest(&self, executor: &mut Executor, stats: &SurfaceStats) -> Result<f32, SurfaceError> {
        let nodes = stats.blocks as usize * NODES;
        let values = block_on(executor.fetch_first(self.b.values, nodes))?;
        Ok(values.into_iter().fold(0.0, f32::max))
    }

    /// Prepares the extraction. The capacity is estimated from the number of particles and grows
    /// when needed.
    ///
    /// # Errors
    /// [`SurfaceError`] if a parameter is invalid, the cells of the grid are smaller than the
    /// support radius, or the device is too small.
    pub fn new(
        executor: &mut Executor,
        params: SurfaceParams,
        input: SurfaceInput,
    ) -> Result<Self, SurfaceError> {
        let largest = executor.largest_buffer();
        let lattice = Lattice::new(&params, &input.grid_host, input.particle_capacity, largest)?;
        Self::with_lattice(executor, params, input, lattice)
    }

    /// As [`new`](Self::new), with an initial capacity in blocks, vertices and triangles.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_capacity(
        executor: &mut Executor,
        params: SurfaceParams,
        input: SurfaceInput,
        blocks: u32,
        vertices: u32,
        triangles: u32,
    ) -> Result<Self, SurfaceError> {
        let largest = executor.largest_buffer();
        let mut lattice = Lattice::new(&params, &input.grid_host, input.particle_capacity, largest)?;
        lattice.block_capacity = blocks.clamp(1, lattice.block_count);
        lattice.vertex_capacity = vertices.max(1);
        lattice.triangle_capacity = triangles.max(1);
        Self::with_lattice(executor, params, input, lattice)
    }

    fn with_lattice(
        executor: &mut Executor,
        params: SurfaceParams,
        input: SurfaceInput,
        lattice: Lattice,
    ) -> Result<Self, SurfaceError> {
        let mut surface = Self {
            params,
            input,
            lattice,
            recording: Recording::new("surface"),
            b: Buffers::new(executor, &lattice)?,
            mark_scan: Scan::new(executor, lattice.block_count)?,
            block_scan: Scan::new(executor, lattice.block_capacity)?,
            vertex_scan: None,
        };
        surface.allocate(executor)?;
        Ok(surface)
    }

    /// Resizes the buffers to the lattice, and rebuilds the list of passes.
    fn allocate(&mut self, executor: &mut Executor) -> Result<(), SurfaceError> {
        let smoothed = self.params.smoothing_iterations > 0;
        self.b.resize(executor, &self.lattice, smoothed)?;
        if self.block_scan.len() != self.lattice.block_capacity {
            self.block_scan = Scan::new(executor, self.lattice.block_capacity)?;
        }
        if smoothed && self.vertex_scan.is_none_or(|scan| scan.len() != self.lattice.vertex_capacity) {
            self.vertex_scan = Some(Scan::new(executor, self.lattice.vertex_capacity)?);
        }
        let mut recording = Recording::new("surface");
        self.record(&mut recording);
        self.recording = recording;
        Ok(())
    }

    /// Appends the extraction to a recording. It is valid until [`grow`](Self::grow) enlarges the
    /// buffers.
    pub fn record(&self, recording: &mut Recording) {
        self.record_field(recording);
        self.record_march(recording);
        if let Some(scan) = &self.vertex_scan {
            self.record_smoothing(recording, scan);
        }
    }

    fn record_field(&self, recording: &mut Recording) {
        let (b, input) = (&self.b, &self.input);
        let (lattice, grid) = (b.lattice.id(), input.grid.id());
        let (cell_start, positions) = (input.cell_start.id(), input.positions.id());
        let particles = Work::Items(input.particle_capacity);
        let (samples, local_density) = (b.samples.id(), b.local_density.id());
        recording.dispatch(
            &volume::VOLUME,
            particles,
            &[lattice, grid, cell_start, positions, samples, local_density],
        );
        recording.clear(b.marks);
        recording.dispatch(&blocks::MARK, particles, &[lattice, grid, cell_start, positions, b.marks.id()]);
        self.mark_scan.record(recording, b.marks, b.mark_starts);
        recording.dispatch(
            &blocks::COMPACT,
            Work::Items(self.lattice.block_count),
            &[lattice, b.marks.id(), b.mark_starts.id(), b.block_list.id(), b.block_slot.id()],
        );
        recording.dispatch(
            &blocks::PLAN,
            Work::Groups(1),
            &[lattice, b.mark_starts.id(), b.status.id(), b.block_groups.id()],
        );
        let (status, list) = (b.status.id(), b.block_list.id());
        recording.dispatch(
            &field::FIELD,
            self.per_block(),
            &[lattice, grid, status, list, cell_start, samples, b.values.id(), b.signs.id()],
        );
    }

    fn record_march(&self, recording: &mut Recording) {
        let b = &self.b;
        let (lattice, status, list, slot) =
            (b.lattice.id(), b.status.id(), b.block_list.id(), b.block_slot.id());
        let (cases, rows) = (b.cases.id(), b.rows.id());
        let (vertex_starts, triangle_starts) = (b.vertex_starts.id(), b.triangle_starts.id());
        // The scans include all slots; slots without a block have zero counts.
        recording.clear(b.vertex_counts);
        recording.clear(b.triangle_counts);
        let counts = [b.vertex_counts.id(), b.triangle_counts.id()];
        recording.dispatch(
            &march::COUNT,
            self.per_block(),
            &[lattice, status, list, slot, b.signs.id(), cases, rows, counts[0], counts[1]],
        );
        self.block_scan.record(recording, b.vertex_counts, b.vertex_starts);
        self.block_scan.record(recording, b.triangle_counts, b.triangle_starts);
        let groups = [b.vertex_groups.id(), b.triangle_groups.id()];
        recording.dispatch(
            &march::FINISH,
            Work::Groups(1),
            &[lattice, vertex_starts, triangle_starts, status, b.draw_args.id(), groups[0], groups[1]],
        );
        let mesh = [b.vertices.id(), b.normals.id()];
        recording.dispatch(
            &march::VERTICES,
            self.per_block(),
            &[lattice, status, list, slot, b.values.id(), rows, vertex_starts, mesh[0], mesh[1]],
        );
        recording.dispatch(
            &march::TRIANGLES,
            self.per_block(),
            &[lattice, status, list, slot, rows, cases, vertex_starts, triangle_starts, b.indices.id()],
        );
    }

    fn record_smoothing(&self, recording: &mut Recording, scan: &Scan) {
        let (b, input) = (&self.b, &self.input);
        let (status, vertices) = (b.status.id(), b.vertices.id());
        let (starts, one_rings, valences) = (b.one_ring_starts.id(), b.one_rings.id(), b.valences.id());
        let per_vertex = Work::Indirect { buffer: b.vertex_groups.id(), word: 0 };
        let per_triangle = Work::Indirect { buffer: b.triangle_groups.id(), word: 0 };
        recording.dispatch(
            &smooth::SMOOTHING_WEIGHTS,
            self.per_block(),
            &[
                b.lattice.id(),
                input.grid.id(),
                status,
                b.vertex_starts.id(),
                input.cell_start.id(),
                b.samples.id(),
                b.local_density.id(),
                vertices,
            ],
        );
        recording.clear(b.valences);
        recording.dispatch(&smooth::VALENCE, per_triangle, &[status, b.indices.id(), valences]);
        scan.record(recording, b.valences, b.one_ring_starts);
        recording.dispatch(
            &smooth::ONE_RING,
            per_triangle,
            &[status, b.indices.id(), starts, valences, one_rings],
        );
        recording.dispatch(&smooth::ONE_RING_ORDER, per_vertex, &[status, starts, one_rings]);
        let (mut from, mut to) = (b.vertices, b.relaxed);
        for _ in 0..self.params.smoothing_iterations {
            recording.dispatch(&smooth::RELAX, per_vertex, &[status, starts, one_rings, from.id(), to.id()]);
            std::mem::swap(&mut from, &mut to);
        }
        if self.params.smoothing_iterations % 2 == 1 {
            recording.copy(b.relaxed, b.vertices);
        }
        recording.dispatch(
            &smooth::VERTEX_NORMALS,
            per_vertex,
            &[status, starts, one_rings, vertices, b.normals.id()],
        );
    }

    fn per_block(&self) -> Work {
        Work::Indirect { buffer: self.b.block_groups.id(), word: 0 }
    }

    /// Extracts the surface and waits until its size is known. If the capacity is too small,
    /// enlarges it and repeats.
    ///
    /// # Errors
    /// [`SurfaceError::Gpu`] if the device was lost or the mesh does not fit it.
    pub fn extract(&mut self, executor: &mut Executor) -> Result<SurfaceStats, SurfaceError> {
        block_on(self.extract_async(executor))
    }

    /// [`extract`](Self::extract) where blocking is not possible, as on a web page.
    ///
    /// # Errors
    /// As [`extract`](Self::extract).
    pub async fn extract_async(&mut self, executor: &mut Executor) -> Result<SurfaceStats, SurfaceError> {
        let mut retries = 0;
        loop {
            executor.run(&self.recording)?;
            let status = self.read_status(executor).await?;
            if !self.grow(executor, &status)? {
                let Status { blocks, vertices, triangles, .. } = status;
                return Ok(SurfaceStats { vertices, triangles, blocks, retries, not_finite: 0 });
            }
            retries += 1;
        }
    }

    /// If the status reports an overflow, enlarges the buffers to the required size plus a quarter
    /// and returns true: earlier recordings are then invalid, and the mesh must be extracted again.
    ///
    /// # Errors
    /// [`SurfaceError::Gpu`] if the device is out of memory.
    pub fn grow(&mut self, executor: &mut Executor, status: &Status) -> Result<bool, SurfaceError> {
        if !status.overflowed() {
            return Ok(false);
        }
        // Assumes that the blocks beyond the capacity have as many vertices as the others.
        let missing = f64::from(status.blocks_needed) / f64::from(status.blocks.max(1));
        let enough = |needed: u32, scale: f64, capacity: u32, most: u32| {
            let wanted = f64::from(needed) * scale;
            if wanted <= f64::from(capacity) { capacity } else { (1.25 * wanted).min(f64::from(most)) as u32 }
        };
        let lattice = &mut self.lattice;
        lattice.block_capacity =
            enough(status.blocks_needed, 1.0, lattice.block_capacity, lattice.block_count);
        let most = MAX_TRIANGLES;
        lattice.vertex_capacity = enough(status.vertices_needed, missing, lattice.vertex_capacity, most);
        lattice.triangle_capacity = enough(status.triangles_needed, missing, lattice.triangle_capacity, most);
        self.allocate(executor)?;
        Ok(true)
    }

    /// Reads back the mesh of the last extraction.
    ///
    /// # Errors
    /// [`SurfaceError::Gpu`] if the device was lost.
    pub fn mesh(&self, executor: &mut Executor) -> Result<Mesh, SurfaceError> {
        block_on(self.mesh_async(executor))
    }

    /// [`mesh`](Self::mesh) where blocking is not possible, as on a web page.
    ///
    /// # Errors
    /// As [`mesh`](Self::mesh).
    pub async fn mesh_async(&self, executor: &mut Executor) -> Result<Mesh, SurfaceError> {
        let status = self.read_status(executor).await?;
        let xyz = |values: Vec<Vec4>| values.into_iter().map(|v| v.truncate().to_array()).collect();
        let vertices = executor.fetch_first(self.b.vertices, status.vertices as usize).await?;
        let normals = executor.fetch_first(self.b.normals, status.vertices as usize).await?;
        let indices = executor.fetch_first(self.b.indices, 3 * status.triangles as usize).await?;
        let triangles = indices.as_chunks::<3>().0.to_vec();
        Ok(Mesh::new(xyz(vertices), triangles).with_normals(xyz(normals)))
    }

    async fn read_status(&self, executor: &mut Executor) -> Result<Status, SurfaceError> {
        Ok(executor.fetch(self.b.status).await?[0])
    }

    /// Releases the memory of the field and of the smoothing. The mesh remains; no other can be
    /// extracted.
    pub(crate) fn release_field(&mut self, executor: &mut Executor) -> Result<(), SurfaceError> {
        let lattice = &mut self.lattice;
        (lattice.particle_capacity, lattice.block_count, lattice.block_capacity) = (0, 0, 0);
        self.b.resize(executor, &self.lattice, false)
    }

    /// Releases the memory of all buffers.
    pub(crate) fn release(mut self, executor: &mut Executor) -> Result<(), SurfaceError> {
        (self.lattice.vertex_capacity, self.lattice.triangle_capacity) = (0, 0);
        self.release_field(executor)
    }

    /// Positions of the vertices in m; w is internal. The first [`Status::vertices`] are valid.
    pub fn vertices(&self) -> Buffer<Vec4> {
        self.b.vertices
    }

    /// Unit normals of the vertices, pointing out of the fluid; w is 0.
    pub fn normals(&self) -> Buffer<Vec4> {
        self.b.normals
    }

    /// Three vertex indices per triangle, counter-clockwise as seen from outside.
    pub fn indices(&self) -> Buffer<u32> {
        self.b.indices
    }

    /// The arguments of an indexed indirect draw: index count, instance count, first index, base
    /// vertex, first instance.
    pub fn draw_args(&self) -> Buffer<u32> {
        self.b.draw_args
    }

    /// The size of the mesh, and whether it exceeded the capacity.
    pub fn status(&self) -> Buffer<Status> {
        self.b.status
    }

    /// The parameters.
    pub fn params(&self) -> &SurfaceParams {
        &self.params
    }
}
