//! The buffers that are drawn. Particles are copied, so that the window can draw them while the next step is computed.
//! The surface is drawn from the buffers of the simulation by an indirect call.

#[cfg(not(target_arch = "wasm32"))]
mod uploaded;

use std::sync::Arc;

use splashdown::Simulation;
use splashdown::foam::Foam;
use splashdown::surface::{Surface, SurfaceStats};
use splashdown_gpu::{Buffer, Executor, Gpu, GpuElement};
use splashdown_render::{Draw, DropletBuffers, FoamBuffers, ParticleBuffers, SurfaceBuffers};
use wgpu::BufferUsages as Use;

/// The particles and, if requested, the surface.
pub struct Drawn {
    positions: wgpu::Buffer,
    velocities: wgpu::Buffer,
    densities: wgpu::Buffer,
    count: u32,
    mesh: Option<DrawnMesh>,
    /// Isolated particles, which are not part of the mesh.
    droplets: Option<(wgpu::Buffer, u32)>,
    foam: Option<(wgpu::Buffer, u32)>,
}

/// The surface: the buffers of the simulation if it runs on the device that draws, else a copy.
pub struct DrawnMesh {
    vertices: wgpu::Buffer,
    normals: wgpu::Buffer,
    indices: wgpu::Buffer,
    /// The arguments of the indirect draw call; `None` for a copy, whose size is known.
    arguments: Option<wgpu::Buffer>,
    /// Its size.
    pub stats: SurfaceStats,
}

impl Drawn {
    /// The particles for the renderer.
    pub fn particles(&self) -> ParticleBuffers<'_> {
        ParticleBuffers {
            positions: &self.positions,
            velocities: &self.velocities,
            densities: &self.densities,
            count: self.count,
        }
    }

    /// Foam, spray and bubbles for the renderer.
    pub fn foam(&self) -> Option<FoamBuffers<'_>> {
        self.foam.as_ref().map(|(particles, count)| FoamBuffers { particles, count: *count })
    }

    /// The droplets beside the surface for the renderer.
    pub fn droplets(&self) -> Option<DropletBuffers<'_>> {
        self.droplets.as_ref().map(|(droplets, count)| DropletBuffers { droplets, count: *count })
    }

    /// The surface.
    pub fn mesh(&self) -> Option<&DrawnMesh> {
        self.mesh.as_ref()
    }
}

impl DrawnMesh {
    /// The buffers for the renderer.
    pub fn buffers(&self) -> SurfaceBuffers<'_> {
        SurfaceBuffers {
            vertices: &self.vertices,
            normals: &self.normals,
            indices: &self.indices,
            draw: match &self.arguments {
                Some(buffer) => Draw::Indirect(buffer, 0),
                None => Draw::Direct { index_count: 3 * self.stats.triangles },
            },
        }
    }
}

/// Makes copies, and reuses those that the window no longer uses.
pub(super) struct Copies {
    gpu: Arc<Gpu>,
    pool: Vec<Arc<Drawn>>,
}

impl Copies {
    pub fn new(gpu: Arc<Gpu>) -> Self {
        Self { gpu, pool: Vec::new() }
    }

    /// Copies the particles, the last extracted surface with its droplets, and the given number of foam particles. The copy is executed
    /// after all work submitted so far.
    pub fn take(
        &mut self,
        simulation: &mut Simulation,
        surface: Option<(&Surface, SurfaceStats)>,
        foam: Option<(&Foam, u32)>,
    ) -> Arc<Drawn> {
        let fields = simulation.fields().clone();
        let count = simulation.params().particle_count;
        let mut old = self.reuse();
        let mut mesh = old.as_mut().and_then(|drawn| drawn.mesh.take());
        let old_droplets = old.as_mut().and_then(|drawn| drawn.droplets.take());
        let old_foam = old.as_mut().and_then(|drawn| drawn.foam.take());
        let mut copy = Copy {
            gpu: &self.gpu,
            encoder: self
                .gpu
                .device
                .create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("snapshot") }),
            executor: simulation.executor(),
        };
        let (p, v, d) = match old {
            Some(Drawn { positions, velocities, densities, .. }) => {
                (Some(positions), Some(velocities), Some(densities))
            }
            None => (None, None, None),
        };
        let n = count as usize;
        let drawn = Drawn {
            positions: copy.take(fields.positions, n, p, Use::STORAGE),
            velocities: copy.take(fields.velocities, n, v, Use::STORAGE),
            densities: copy.take(fields.densities, n, d, Use::STORAGE),
            count,
            foam: foam.map(|(foam, count)| {
                let old = old_foam.map(|(old, _)| old);
                (copy.take(foam.pool(), count as usize, old, Use::STORAGE), count)
            }),
            droplets: surface.filter(|(_, stats)| stats.droplets > 0).map(|(surface, stats)| {
                let old = old_droplets.map(|(old, _)| old);
                let count = stats.droplets;
                (copy.take(surface.droplets(), count as usize, old, Use::STORAGE), count)
            }),
            mesh: surface.map(|(surface, stats)| {
                if let Some(shared) = shared(copy.executor, surface, stats) {
                    return shared;
                }
                let (vertices, triangles) = (stats.vertices as usize, 3 * stats.triangles as usize);
                let (v, n, i) = match mesh.take() {
                    Some(old) if old.arguments.is_none() => {
                        (Some(old.vertices), Some(old.normals), Some(old.indices))
                    }
                    _ => (None, None, None),
                };
                DrawnMesh {
                    arguments: None,
                    vertices: copy.take(surface.vertices(), vertices, v, Use::VERTEX | Use::STORAGE),
                    normals: copy.take(surface.normals(), vertices, n, Use::VERTEX),
                    indices: copy.take(surface.indices(), triangles, i, Use::INDEX | Use::STORAGE),
                    stats,
                }
            }),
        };
        let commands = copy.encoder.finish();
        self.gpu.queue.submit([commands]);
        let drawn = Arc::new(drawn);
        self.pool.push(Arc::clone(&drawn));
        drawn
    }

    /// A copy that the window no longer uses.
    fn reuse(&mut self) -> Option<Drawn> {
        let free = self.pool.iter().position(|drawn| Arc::strong_count(drawn) == 1)?;
        Arc::into_inner(self.pool.swap_remove(free))
    }
}

/// The simulation's own surface, if it is on the device that draws. One submission replaces the whole surface, so the
/// drawn surface is consistent; it may be newer than the snapshot.
fn shared(executor: &Executor, surface: &Surface, stats: SurfaceStats) -> Option<DrawnMesh> {
    let buffer = |id| executor.wgpu_buffer(id).cloned();
    Some(DrawnMesh {
        vertices: buffer(surface.vertices().id())?,
        normals: buffer(surface.normals().id())?,
        indices: buffer(surface.indices().id())?,
        arguments: Some(buffer(surface.draw_args().id())?),
        stats,
    })
}

struct Copy<'a> {
    gpu: &'a Gpu,
    encoder: wgpu::CommandEncoder,
    executor: &'a mut Executor,
}

impl Copy<'_> {
    /// Copies the first `len` elements of a buffer, into the old copy if it is large enough.
    fn take<T: GpuElement>(
        &mut self,
        from: Buffer<T>,
        len: usize,
        old: Option<wgpu::Buffer>,
        usage: Use,
    ) -> wgpu::Buffer {
        let bytes = (len * size_of::<T>()) as u64;
        let to = old.filter(|old| old.size() >= bytes).unwrap_or_else(|| {
            self.gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("snapshot"),
                // A quarter larger than required, so that a growing simulation rarely reallocates; never empty.
                size: (bytes + bytes / 4).next_multiple_of(16).max(16),
                usage: usage | Use::COPY_DST,
                mapped_at_creation: false,
            })
        });
        if bytes > 0 {
            match self.executor.wgpu_buffer(from.id()) {
                Some(from) => self.encoder.copy_buffer_to_buffer(from, 0, &to, 0, bytes),
                None => {
                    let queue = &self.gpu.queue;
                    self.executor.with_host(from, |all: &[T]| {
                        queue.write_buffer(&to, 0, bytemuck::cast_slice(&all[..len]));
                    });
                }
            }
        }
        to
    }
}
