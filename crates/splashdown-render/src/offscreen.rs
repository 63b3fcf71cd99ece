//! Pictures without a window: drawn into a texture and read back asynchronously.

use crate::renderer::check_size;
use crate::{Frame, RenderError, Renderer, Ticket};
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, channel};
use wgpu::{
    Buffer, BufferAsyncError, BufferUsages, CommandEncoder, Device, Extent3d, MapMode, PollType, Queue,
    SubmissionIndex, TexelCopyBufferInfo, TexelCopyBufferLayout, Texture, TextureFormat, TextureUsages,
    TextureView,
};

/// A texture to draw into, and buffers to read pictures back.
///
/// Up to [`Offscreen::FRAMES_IN_FLIGHT`] pictures can be submitted before the first is collected,
/// so that the GPU draws while the host simulates, encodes or writes.
#[derive(Debug)]
pub struct Offscreen {
    device: Device,
    queue: Queue,
    size: [u32; 2],
    texture: Texture,
    identity: u64,
    submitted: u64,
    free: Vec<Buffer>,
    in_flight: Vec<InFlight>,
}

#[derive(Debug)]
struct InFlight {
    number: u64,
    buffer: Buffer,
    submission: SubmissionIndex,
    mapped: Receiver<Result<(), BufferAsyncError>>,
}

impl Offscreen {
    /// Format of the texture; create the [`Renderer`] with the same format.
    pub const FORMAT: TextureFormat = TextureFormat::Rgba8UnormSrgb;
    /// Largest number of pictures that are submitted and not yet collected.
    pub const FRAMES_IN_FLIGHT: usize = 3;

    /// Creates a target of `size` (width, height) pixels.
    ///
    /// # Errors
    /// [`RenderError::PictureSize`] if a side is 0 or exceeds the limit of the device,
    /// [`RenderError::DeviceLost`] if the device is out of memory.
    pub fn new(device: &Device, queue: &Queue, size: [u32; 2]) -> Result<Offscreen, RenderError> {
        static IDENTITIES: AtomicU64 = AtomicU64::new(0);
        check_size(device, size)?;
        with_error_scopes(device, || {
            Ok(Offscreen::allocate(device, queue, size, IDENTITIES.fetch_add(1, Ordering::Relaxed)))
        })
    }

    fn allocate(device: &Device, queue: &Queue, size: [u32; 2], identity: u64) -> Offscreen {
        let bytes = u64::from(padded_row(size[0])) * u64::from(size[1]);
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("offscreen"),
            size: extent(size),
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: Offscreen::FORMAT,
            usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let read_back = || {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("read-back"),
                size: bytes,
                usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
                mapped_at_creation: false,
            })
        };
        Offscreen {
            free: (0..Offscreen::FRAMES_IN_FLIGHT).map(|_| read_back()).collect(),
            device: device.clone(),
            queue: queue.clone(),
            size,
            texture,
            identity,
            submitted: 0,
            in_flight: Vec::new(),
        }
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Submits a picture without waiting for it.
    ///
    /// # Errors
    /// [`RenderError::FramesInFlight`] if a picture must be collected first,
    /// [`RenderError::Format`] if the renderer was created for another format,
    /// [`RenderError::DeviceLost`] if the device is lost or out of memory, and the errors of
    /// [`Renderer::draw`].
    pub fn submit(&mut self, renderer: &mut Renderer, frame: &Frame<'_>) -> Result<Ticket, RenderError> {
        self.submit_from(renderer, frame, 0)
    }

    /// Submits some samples of a picture with [traced rays](Frame::with_tracing), which
    /// [`submit_from`](Self::submit_from) completes. The samples of a picture are drawn in order, and may show frames
    /// that differ by what moves while the shutter is open: see [`Quality::time`](crate::Quality::time).
    ///
    /// # Errors
    /// As [`submit`](Self::submit).
    pub fn submit_samples(
        &mut self,
        renderer: &mut Renderer,
        frame: &Frame<'_>,
        samples: Range<u32>,
    ) -> Result<(), RenderError> {
        check_format(renderer)?;
        with_error_scopes(&self.device, || {
            // A submission per sample: drivers stop those that take seconds.
            for sample in samples {
                let mut encoder = self.encoder();
                let range = sample..sample + 1;
                renderer.draw_samples(&mut encoder, &self.view(), self.size, frame, range)?;
                self.queue.submit([encoder.finish()]);
            }
            Ok(())
        })
    }

    /// Submits the samples of a picture from number `first` on, which complete it. Without traced rays a picture has only
    /// one.
    ///
    /// # Errors
    /// As [`submit`](Self::submit).
    pub fn submit_from(
        &mut self,
        renderer: &mut Renderer,
        frame: &Frame<'_>,
        first: u32,
    ) -> Result<Ticket, RenderError> {
        check_format(renderer)?;
        let Some(buffer) = self.free.last().cloned() else {
            return Err(RenderError::FramesInFlight { limit: Offscreen::FRAMES_IN_FLIGHT });
        };
        let last = frame.traced_samples().map(|samples| samples.saturating_sub(1));
        if let Some(last) = last {
            self.submit_samples(renderer, frame, first..last)?;
        }
        let submission = with_error_scopes(&self.device, || {
            let (view, mut encoder) = (self.view(), self.encoder());
            match last {
                None => renderer.draw(&mut encoder, &view, self.size, frame)?,
                Some(last) => {
                    renderer.draw_samples(&mut encoder, &view, self.size, frame, last..last + 1)?;
                }
            }
            let layout = TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(padded_row(self.size[0])),
                rows_per_image: Some(self.size[1]),
            };
            let destination = TexelCopyBufferInfo { buffer: &buffer, layout };
            encoder.copy_texture_to_buffer(self.texture.as_image_copy(), destination, extent(self.size));
            Ok(self.queue.submit([encoder.finish()]))
        })?;

        let (sender, mapped) = channel();
        buffer.map_async(MapMode::Read, .., move |result| {
            // Sending fails only if the target has been dropped.
            let _ = sender.send(result);
        });
        let number = self.submitted;
        self.submitted += 1;
        self.free.pop();
        self.in_flight.push(InFlight { number, buffer, submission, mapped });
        Ok(Ticket { target: self.identity, number })
    }

    fn view(&self) -> TextureView {
        self.texture.create_view(&wgpu::TextureViewDescriptor::default())
    }

    fn encoder(&self) -> CommandEncoder {
        self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("picture") })
    }

    /// Waits for a submitted picture. The result is 8-bit RGBA, sRGB-encoded, row by row from the
    /// upper left, without padding.
    ///
    /// # Errors
    /// [`RenderError::UnknownTicket`] for the ticket of another target, [`RenderError::DeviceLost`]
    /// if the device was lost.
    pub fn collect(&mut self, ticket: Ticket) -> Result<Vec<u8>, RenderError> {
        let index = self.in_flight.iter().position(|picture| picture.number == ticket.number);
        let Some(index) = index.filter(|_| ticket.target == self.identity) else {
            return Err(RenderError::UnknownTicket { ticket });
        };
        let InFlight { buffer, submission, mapped, .. } = self.in_flight.remove(index);
        let lost = |reason: String| RenderError::DeviceLost { reason };
        let waiting = PollType::Wait { submission_index: Some(submission), timeout: None };
        self.device.poll(waiting).map_err(|error| lost(error.to_string()))?;
        mapped
            .recv()
            .map_err(|_| lost("the read-back was cancelled".to_owned()))?
            .map_err(|error| lost(error.to_string()))?;
        let pixels = {
            let padded = buffer.get_mapped_range(..).map_err(|error| lost(error.to_string()))?;
            let rows = padded.chunks_exact(padded_row(self.size[0]) as usize);
            let mut pixels = Vec::with_capacity(4 * self.size[0] as usize * self.size[1] as usize);
            rows.for_each(|row| pixels.extend_from_slice(&row[..4 * self.size[0] as usize]));
            pixels
        };
        buffer.unmap();
        self.free.push(buffer);
        Ok(pixels)
    }

    /// Draws a picture and waits for it; see [`Offscreen::collect`] for the layout of the result.
    ///
    /// # Errors
    /// The errors of [`Offscreen::submit`] and [`Offscreen::collect`].
    pub fn render_to_rgba(
        &mut self,
        renderer: &mut Renderer,
        frame: &Frame<'_>,
    ) -> Result<Vec<u8>, RenderError> {
        let ticket = self.submit(renderer, frame)?;
        self.collect(ticket)
    }
}

/// Returns errors that the device reports during `work`; without error scopes, wgpu panics.
#[cfg(not(target_arch = "wasm32"))]
fn with_error_scopes<T>(
    device: &Device,
    work: impl FnOnce() -> Result<T, RenderError>,
) -> Result<T, RenderError> {
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let result = work();
    // Both scopes must be popped, the inner one first.
    let (validation, memory) =
        (splashdown_gpu::block_on(validation.pop()), splashdown_gpu::block_on(memory.pop()));
    match memory.or(validation) {
        Some(error) => Err(RenderError::DeviceLost { reason: error.to_string() }),
        None => result,
    }
}

/// A browser cannot wait for an error scope; errors appear in the console of the page.
#[cfg(target_arch = "wasm32")]
fn with_error_scopes<T>(_: &Device, work: impl FnOnce() -> Result<T, RenderError>) -> Result<T, RenderError> {
    work()
}

fn check_format(renderer: &Renderer) -> Result<(), RenderError> {
    match renderer.format() == Offscreen::FORMAT {
        true => Ok(()),
        false => Err(RenderError::Format { renderer: renderer.format(), target: Offscreen::FORMAT }),
    }
}

fn extent([width, height]: [u32; 2]) -> Extent3d {
    Extent3d { width, height, depth_or_array_layers: 1 }
}

/// Bytes per row of a texture-to-buffer copy.
fn padded_row(width: u32) -> u32 {
    (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
}
