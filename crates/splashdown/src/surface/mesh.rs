//! Surface extraction: buffers, list of passes, growth of the buffers.

use glam::{UVec2, Vec4};
use splashdown_gpu::scan::Scan;
use splashdown_gpu::{Buffer, BufferId, BufferSet, DispatchSize, Executor, Recording, block_on, buffer_set};
use splashdown_io::{Mesh, Particles};

use super::droplets::{self, Droplet};
use super::params::{Lattice, MAX_TRIANGLES, NODES, ROWS, Status, SurfaceParams};
use super::{SurfaceError, anisotropy, blocks, field, march, smooth, solids, volume};
use crate::bodies::Solids;
use crate::cells::Grid;
use crate::marching_cubes;
use crate::scene::{SurfaceKernels, SurfaceSettings};

/// The particles of a surface, in the buffers of the simulation. The label of each buffer is the
/// name of its field.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceInput {
    /// Positions in m, sorted by cell; w is ignored.
    pub sorted_positions: Buffer<Vec4>,
    /// Velocities in m/s, sorted by cell; w is ignored. Empty if no particles leave the surface.
    pub sorted_velocities: Buffer<Vec4>,
    /// Ids, sorted by cell. Empty if no particles leave the surface.
    pub sorted_ids: Buffer<u32>,
    /// First particle of every cell, followed by the number of active particles.
    pub cell_start: Buffer<u32>,
    /// The neighbour grid on the device.
    pub grid: Buffer<Grid>,
    /// The same grid on the host.
    pub grid_host: Grid,
    /// Largest number of particles.
    pub particle_capacity: u32,
    /// The bodies at which the surface ends.
    pub solids: Option<Solids>,
}

impl SurfaceInput {
    /// The buffers by name, for recordings.
    pub(super) fn buffers(&self) -> BufferSet {
        buffer_set!(self => sorted_positions, sorted_velocities, sorted_ids, cell_start, grid)
    }
}

/// Size of a mesh, and statistics of its extraction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct SurfaceStats {
    /// Number of vertices.
    pub vertices: u32,
    /// Number of triangles.
    pub triangles: u32,
    /// Number of blocks of 8x8x8 nodes near particles.
    pub blocks: u32,
    /// Number of repetitions of the extraction because the capacity was too small.
    pub retries: u32,
    /// Number of isolated particles, which are not part of the mesh.
    pub droplets: u32,
    /// Number of particles that were skipped because a coordinate was NaN or infinite. Only host
    /// data can contain these.
    pub not_finite: u32,
}

/// Extracts the surface of the particles of a simulation repeatedly, on the device.
///
/// [`Simulation::surface`](crate::Simulation::surface) creates it,
/// [`Simulation::extract`](crate::Simulation::extract) extracts the surface, and
/// [`Simulation::mesh`](crate::Simulation::mesh) reads the mesh back.
//
// Without blocking: `record` into the recording of a frame, draw with `draw_args`, request `status`
// and pass it to `grow` when it arrives; if that enlarges the buffers, record again.
#[derive(Debug)]
pub struct Surface {
    params: SurfaceParams,
    input: SurfaceInput,
    lattice: Lattice,
    pub(super) recording: Recording,
    pub(super) b: Buffers,
    kept_scan: Option<Scan>,
    mark_scan: Scan,
    block_scan: Scan,
    vertex_scan: Option<Scan>,
}

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
    fn new(executor: &mut Executor, lattice: &Lattice) -> Result<Self, SurfaceError> {
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
    fn by_name(&self) -> BufferSet {
        buffer_set!(self =>
            lattice, cases, kept, kept_starts, kept_positions, kept_cell_start, droplets, droplet_count, samples, neighbour_moments, kernel_centres, kernel_matrices, local_density, marks, mark_starts, block_slot, block_list, field_values, signs, rows,
            vertex_counts, triangle_counts, vertex_starts, triangle_starts, status, draw_args, block_groups,
            vertex_groups, triangle_groups, vertex_positions, normals, indices, valences, one_ring_starts, one_rings,
            relaxed,
        )
    }

    /// Resizes every buffer to the capacities of the lattice.
    fn resize(
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

impl Surface {
    /// The largest value of the field at the nodes of the last extraction.
    pub(super) fn highest(&self, executor: &mut Executor, stats: &SurfaceStats) -> Result<f32, SurfaceError> {
        let nodes = stats.blocks as usize * NODES;
        let values = block_on(executor.fetch_first(self.b.field_values, nodes))?;
        Ok(values.into_iter().fold(0.0, f32::max))
    }

    /// Prepares the extraction. The capacity is estimated from the number of particles and grows
    /// when needed.
    ///
    /// # Errors
    /// [`SurfaceError`] if a parameter is invalid, the cells of the grid are smaller than the
    /// support radius, or the device is too small.
    #[doc(hidden)]
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
    #[doc(hidden)]
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
            kept_scan: None,
            mark_scan: Scan::new(executor, lattice.block_count)?,
            block_scan: Scan::new(executor, lattice.block_capacity)?,
            vertex_scan: None,
        };
        match surface.allocate(executor) {
            Ok(()) => Ok(surface),
            Err(error) => {
                surface.free(executor)?;
                Err(error)
            }
        }
    }

    /// Resizes the buffers to the lattice, and rebuilds the list of passes.
    fn allocate(&mut self, executor: &mut Executor) -> Result<(), SurfaceError> {
        let smoothed = self.params.smoothing_iterations > 0;
        self.b.resize(executor, &self.lattice, &self.params, self.input.grid_host.cell_count)?;
        if self.params.separates() && self.kept_scan.is_none() {
            self.kept_scan = Some(Scan::new(executor, self.input.particle_capacity)?);
        }
        if self.block_scan.len() != self.lattice.block_capacity {
            let scan = Scan::new(executor, self.lattice.block_capacity)?;
            std::mem::replace(&mut self.block_scan, scan).free(executor)?;
        }
        if smoothed && self.vertex_scan.is_none_or(|scan| scan.len() != self.lattice.vertex_capacity) {
            let scan = Scan::new(executor, self.lattice.vertex_capacity)?;
            if let Some(old) = self.vertex_scan.replace(scan) {
                old.free(executor)?;
            }
        }
        let mut recording = Recording::new("surface");
        self.record(&mut recording);
        self.recording = recording;
        Ok(())
    }

    /// Appends the extraction to a recording. It is valid until [`grow`](Self::grow) enlarges the
    /// buffers.
    #[doc(hidden)]
    pub fn record(&self, recording: &mut Recording) {
        let mut buffers = self.b.by_name().and(&self.input.buffers());
        if let Some(scan) = &self.kept_scan {
            self.record_separation(recording, &buffers, scan);
            buffers = buffers
                .with("sorted_positions", self.b.kept_positions)
                .with("cell_start", self.b.kept_cell_start);
        }
        self.record_field(recording, &buffers);
        self.record_march(recording, &buffers);
        if let Some(scan) = &self.vertex_scan {
            self.record_smoothing(recording, &buffers, scan);
        }
    }

    fn record_separation(&self, recording: &mut Recording, buffers: &BufferSet, scan: &Scan) {
        let particles = DispatchSize::Items(self.input.particle_capacity);
        let cells = DispatchSize::Items(self.input.grid_host.cell_count + 1);
        // The scan includes inactive particles.
        recording.clear(self.b.kept);
        recording.dispatch(&droplets::CLASSIFY, particles, buffers);
        scan.record(recording, self.b.kept, self.b.kept_starts);
        recording.dispatch(&droplets::SEPARATE, particles, buffers);
        recording.dispatch(&droplets::KEPT_CELLS, cells, buffers);
    }

    fn record_field(&self, recording: &mut Recording, buffers: &BufferSet) {
        let particles = DispatchSize::Items(self.input.particle_capacity);
        let is_anisotropic = self.params.kernels == SurfaceKernels::Anisotropic;
        if is_anisotropic {
            recording.dispatch(&anisotropy::MOMENTS, particles, buffers);
            recording.dispatch(&anisotropy::SHAPES, particles, buffers);
            recording.dispatch(&anisotropy::WEIGHTS, particles, buffers);
        } else {
            recording.dispatch(&volume::VOLUME, particles, buffers);
        }
        recording.clear(self.b.marks);
        recording.dispatch(&blocks::MARK, particles, buffers);
        self.mark_scan.record(recording, self.b.marks, self.b.mark_starts);
        recording.dispatch(&blocks::COMPACT, DispatchSize::Items(self.lattice.block_count), buffers);
        recording.dispatch(&blocks::PLAN, DispatchSize::Groups(1), buffers);
        let field = if is_anisotropic { &field::STRETCHED_FIELD } else { &field::FIELD };
        recording.dispatch(field, self.per_block(), buffers);
        if let Some(solids) = &self.input.solids {
            recording.dispatch(&solids::CLIP, self.per_block(), &buffers.clone().and(&solids.buffers()));
        }
    }

    fn record_march(&self, recording: &mut Recording, buffers: &BufferSet) {
        let b = &self.b;
        // The scans include all slots; slots without a block have zero counts.
        recording.clear(b.vertex_counts);
        recording.clear(b.triangle_counts);
        recording.dispatch(&march::COUNT, self.per_block(), buffers);
        self.block_scan.record(recording, b.vertex_counts, b.vertex_starts);
        self.block_scan.record(recording, b.triangle_counts, b.triangle_starts);
        recording.dispatch(&march::FINISH, DispatchSize::Groups(1), buffers);
        recording.dispatch(&march::VERTICES, self.per_block(), buffers);
        recording.dispatch(&march::TRIANGLES, self.per_block(), buffers);
    }

    fn record_smoothing(&self, recording: &mut Recording, buffers: &BufferSet, scan: &Scan) {
        let b = &self.b;
        let per_vertex = DispatchSize::indirect(b.vertex_groups);
        let per_triangle = DispatchSize::indirect(b.triangle_groups);
        recording.dispatch(&smooth::SMOOTHING_WEIGHTS, self.per_block(), buffers);
        if let Some(solids) = &self.input.solids {
            recording.dispatch(&solids::PIN, per_vertex, &buffers.clone().and(&solids.buffers()));
        }
        recording.clear(b.valences);
        recording.dispatch(&smooth::VALENCE, per_triangle, buffers);
        scan.record(recording, b.valences, b.one_ring_starts);
        recording.dispatch(&smooth::ONE_RING, per_triangle, buffers);
        recording.dispatch(&smooth::ONE_RING_ORDER, per_vertex, buffers);
        let there = buffers.clone().with("before", b.vertex_positions).with("after", b.relaxed);
        let back = buffers.clone().with("before", b.relaxed).with("after", b.vertex_positions);
        for iteration in 0..self.params.smoothing_iterations {
            let buffers = if iteration % 2 == 0 { &there } else { &back };
            recording.dispatch(&smooth::RELAX, per_vertex, buffers);
        }
        if self.params.smoothing_iterations % 2 == 1 {
            recording.copy(b.relaxed, b.vertex_positions);
        }
        recording.dispatch(&smooth::VERTEX_NORMALS, per_vertex, buffers);
    }

    fn per_block(&self) -> DispatchSize {
        DispatchSize::indirect(self.b.block_groups)
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
            let droplets = executor.request(self.b.droplet_count, 1)?;
            if !self.grow(executor, &status)? {
                let Status { blocks, vertices, triangles, .. } = status;
                let droplets = droplets.take().await?[0];
                return Ok(SurfaceStats { vertices, triangles, blocks, retries, droplets, not_finite: 0 });
            }
            retries += 1;
        }
    }

    /// If the status reports an overflow, enlarges the buffers to the required size plus a quarter
    /// and returns true: earlier recordings are then invalid, and the mesh must be extracted again.
    ///
    /// # Errors
    /// [`SurfaceError::Gpu`] if the device is out of memory.
    #[doc(hidden)]
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
        let vertices = executor.fetch_first(self.b.vertex_positions, status.vertices as usize).await?;
        let normals = executor.fetch_first(self.b.normals, status.vertices as usize).await?;
        let indices = executor.fetch_first(self.b.indices, 3 * status.triangles as usize).await?;
        let triangles = indices.as_chunks::<3>().0.to_vec();
        Ok(Mesh::new(xyz(vertices), triangles).with_normals(xyz(normals)))
    }

    /// Reads back the isolated particles of the last extraction in the order of their ids: ids, positions and
    /// velocities, and their diameter in m as the attribute `width`.
    ///
    /// # Errors
    /// [`SurfaceError::Gpu`] if the device was lost.
    pub async fn droplets_async(&self, executor: &mut Executor) -> Result<Particles, SurfaceError> {
        let count = executor.fetch(self.b.droplet_count).await?[0];
        let mut found = executor.fetch_first(self.b.droplets, count as usize).await?;
        found.sort_unstable_by_key(|droplet| droplet.id);
        let all = Particles::from_positions(found.iter().map(|droplet| droplet.position.into()).collect())
            .with_ids(found.iter().map(|droplet| droplet.id).collect())
            .with_velocities(found.iter().map(|droplet| droplet.velocity.into()).collect());
        let indices: Vec<u32> = (0..count).collect();
        Ok(droplets::droplets_of(&all, &indices, self.params.particle_spacing))
    }

    async fn read_status(&self, executor: &mut Executor) -> Result<Status, SurfaceError> {
        Ok(executor.fetch(self.b.status).await?[0])
    }

    /// Frees the buffers. Recordings of this surface become invalid; the input remains.
    ///
    /// # Errors
    /// [`SurfaceError::Gpu`] if this is not the executor of the surface.
    pub fn free(self, executor: &mut Executor) -> Result<(), SurfaceError> {
        self.free_scans(executor)?;
        Ok(executor.free(self.b.by_name().ids())?)
    }

    /// Reads back the mesh of the last extraction and frees the buffers: those without the mesh
    /// before it is copied, because the field takes most of the memory.
    pub(crate) fn into_mesh(self, executor: &mut Executor) -> Result<Mesh, SurfaceError> {
        let b = &self.b;
        let of_mesh = buffer_set!(b => status, vertex_positions, normals, indices);
        let is_of_mesh = |id: &BufferId| of_mesh.ids().any(|other| other == *id);
        self.free_scans(executor)?;
        executor.free(b.by_name().ids().filter(|id| !is_of_mesh(id)))?;
        let mesh = self.mesh(executor);
        executor.free(of_mesh.ids())?;
        mesh
    }

    fn free_scans(&self, executor: &mut Executor) -> Result<(), SurfaceError> {
        let optional = self.kept_scan.into_iter().chain(self.vertex_scan);
        for scan in [self.mark_scan, self.block_scan].into_iter().chain(optional) {
            scan.free(executor)?;
        }
        Ok(())
    }

    /// Positions of the vertices in m; w is internal. The first [`Status::vertices`] are valid.
    #[doc(hidden)]
    pub fn vertices(&self) -> Buffer<Vec4> {
        self.b.vertex_positions
    }

    /// Unit normals of the vertices, pointing out of the fluid; w is 0.
    #[doc(hidden)]
    pub fn normals(&self) -> Buffer<Vec4> {
        self.b.normals
    }

    /// Three vertex indices per triangle, counter-clockwise as seen from outside.
    #[doc(hidden)]
    pub fn indices(&self) -> Buffer<u32> {
        self.b.indices
    }

    /// The arguments of an indexed indirect draw: index count, instance count, first index, base
    /// vertex, first instance.
    #[doc(hidden)]
    pub fn draw_args(&self) -> Buffer<u32> {
        self.b.draw_args
    }

    /// The size of the mesh, and whether it exceeded the capacity.
    #[doc(hidden)]
    pub fn status(&self) -> Buffer<Status> {
        self.b.status
    }

    /// The isolated particles; the first [`SurfaceStats::droplets`] are valid. Empty if none leave the surface.
    #[doc(hidden)]
    pub fn droplets(&self) -> Buffer<Droplet> {
        self.b.droplets
    }

    /// The parameters.
    pub fn params(&self) -> &SurfaceParams {
        &self.params
    }
}
