//! Read-back of a texture to the host.

use crate::RenderError;
use std::sync::mpsc::{Receiver, channel};
use wgpu::{
    Buffer, BufferAsyncError, BufferUsages, CommandEncoder, Device, Extent3d, MapMode, PollType,
    SubmissionIndex, TexelCopyBufferInfo, TexelCopyBufferLayout, Texture,
};

/// A copy of a texture on its way to the host.
#[derive(Debug)]
pub(crate) struct ReadBack {
    buffer: Buffer,
    submission: SubmissionIndex,
    mapped: Receiver<Result<(), BufferAsyncError>>,
}

/// A buffer for textures of this size with 4 bytes per pixel.
pub(crate) fn buffer(device: &Device, [width, height]: [u32; 2]) -> Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read-back"),
        size: u64::from(padded_row(width)) * u64::from(height),
        usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
        mapped_at_creation: false,
    })
}

/// Records the copy of a whole texture.
pub(crate) fn record(encoder: &mut CommandEncoder, texture: &Texture, buffer: &Buffer) {
    let Extent3d { width, height, .. } = texture.size();
    let layout = TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(padded_row(width)),
        rows_per_image: Some(height),
    };
    let destination = TexelCopyBufferInfo { buffer, layout };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), destination, texture.size());
}

impl ReadBack {
    /// Waits in the background for a submission that contains the copy.
    pub fn start(buffer: Buffer, submission: SubmissionIndex) -> ReadBack {
        let (sender, mapped) = channel();
        buffer.map_async(MapMode::Read, .., move |result| {
            // Sending fails only if the target has been dropped.
            let _ = sender.send(result);
        });
        ReadBack { buffer, submission, mapped }
    }

    /// Waits for the copy and passes each row of a texture of this width, without padding. Returns the buffer.
    ///
    /// # Errors
    /// [`RenderError::DeviceLost`].
    pub fn wait(
        self,
        device: &Device,
        width: u32,
        mut take: impl FnMut(usize, &[u8]),
    ) -> Result<Buffer, RenderError> {
        let ReadBack { buffer, submission, mapped } = self;
        let lost = |reason: String| RenderError::DeviceLost { reason };
        let waiting = PollType::Wait { submission_index: Some(submission), timeout: None };
        device.poll(waiting).map_err(|error| lost(error.to_string()))?;
        mapped
            .recv()
            .map_err(|_| lost("the read-back was cancelled".to_owned()))?
            .map_err(|error| lost(error.to_string()))?;
        {
            let padded = buffer.get_mapped_range(..).map_err(|error| lost(error.to_string()))?;
            for (number, row) in padded.chunks_exact(padded_row(width) as usize).enumerate() {
                take(number, &row[..4 * width as usize]);
            }
        }
        buffer.unmap();
        Ok(buffer)
    }
}

/// Bytes per row of a texture-to-buffer copy.
fn padded_row(width: u32) -> u32 {
    (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
}
