//! Reading back a texture.

use std::sync::Arc;

use splashdown_gpu::Gpu;

/// 8-bit RGBA rows from the top; `None` if the device was lost.
pub async fn read(gpu: Arc<Gpu>, texture: wgpu::Texture, [width, height]: [u32; 2]) -> Option<Vec<u8>> {
    let row = 4 * width;
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let staging = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("picture"),
        size: u64::from(padded) * u64::from(height),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &staging,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(padded),
                rows_per_image: None,
            },
        },
        wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
    );
    let submission = gpu.queue.submit([encoder.finish()]);
    let bytes = gpu.read_back(staging, submission).await.ok()?;
    Some(bytes.chunks_exact(padded as usize).flat_map(|line| &line[..row as usize]).copied().collect())
}
