//! Surface extraction: list of passes, growth of the buffers, the mesh on the host.

use glam::Vec4;
use splashdown_gpu::scan::Scan;
use splashdown_gpu::{Buffer, BufferId, BufferSet, DispatchSize, Executor, Recording, block_on, buffer_set};
use splashdown_io::{Mesh, Particles};

use super::buffers::Buffers;
use super::droplets::{self, Droplet};
use super::params::{Lattice, MAX_TRIANGLES, NODES, Status, SurfaceParams};
use super::{SurfaceError, anisotropy, blocks, field, march, smooth, solids, volume};
use crate::bodies::Solids;
use crate::cells::Grid;
use crate::scene::SurfaceKernels;

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
