//! Particle buffers split into chunks that each fit one storage binding.
//!
//! WebGPU limits the size of a storage binding (128 MiB by default), so large particle sets are
//! drawn chunk by chunk.

use crate::pipeline::bind_group;
use std::num::NonZeroU64;
use wgpu::{BindGroup, BindGroupLayout, BindingResource, Buffer, BufferBinding, Device, RenderPass};

/// Binding offsets must be multiples of 256 bytes. A multiple of this many particles always is one.
const ALIGNMENT: u32 = 256;

/// A storage buffer with one element per particle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Column<'a> {
    pub buffer: &'a Buffer,
    /// Bytes per particle.
    pub stride: u64,
}

/// A bind group with a range of the particles.
#[derive(Debug)]
pub(crate) struct Chunk {
    group: BindGroup,
    count: u32,
}

impl Chunk {
    /// Binds the chunk as group `index` and draws a number of vertices for each of its particles.
    pub fn draw(&self, pass: &mut RenderPass<'_>, index: u32, vertices_per_particle: u32) {
        pass.set_bind_group(index, &self.group, &[]);
        pass.draw(0..vertices_per_particle * self.count, 0..1);
    }
}

/// Binds `count` particles in as few chunks as the device allows: the columns from binding 0 on,
/// then `others`.
pub(crate) fn bind_chunks(
    device: &Device,
    label: &str,
    layout: &BindGroupLayout,
    count: u32,
    columns: &[Column<'_>],
    others: &[BindingResource<'_>],
) -> Vec<Chunk> {
    let largest_stride = columns.iter().map(|column| column.stride).max().unwrap_or(1);
    ranges(device.limits().max_storage_buffer_binding_size, count, largest_stride)
        .map(|(start, count)| {
            let columns = columns.iter().map(|column| {
                BindingResource::Buffer(BufferBinding {
                    buffer: column.buffer,
                    offset: column.stride * u64::from(start),
                    size: NonZeroU64::new(column.stride * u64::from(count)),
                })
            });
            let resources: Vec<BindingResource<'_>> = columns.chain(others.iter().cloned()).collect();
            Chunk { group: bind_group(device, label, layout, &resources), count }
        })
        .collect()
}

/// First particle and number of particles of each chunk.
fn ranges(binding_limit: u64, count: u32, stride: u64) -> impl Iterator<Item = (u32, u32)> {
    // With six vertices per particle, the number of vertices of a chunk must fit in 32 bits.
    let fitting = (binding_limit / stride).min(u64::from(u32::MAX / 6)) as u32;
    let largest = (fitting / ALIGNMENT * ALIGNMENT).max(ALIGNMENT);
    (0..count).step_by(largest as usize).map(move |start| (start, largest.min(count - start)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunks_cover_all_particles_and_respect_the_limit() {
        for (limit, count, stride) in [(128 << 20, 20_000_000, 16), (1 << 20, 100_000, 32), (1 << 20, 0, 16)]
        {
            let mut next = 0;
            for (start, length) in ranges(limit, count, stride) {
                assert_eq!(start, next);
                assert!(start % ALIGNMENT == 0 && length > 0 && u64::from(length) * stride <= limit);
                next = start + length;
            }
            assert_eq!(next, count);
        }
        assert_eq!(ranges(128 << 20, 8_000_000, 16).count(), 1, "one chunk where one is enough");
    }
}
