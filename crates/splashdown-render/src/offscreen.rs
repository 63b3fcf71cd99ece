//! Pictures without a window: drawn into a texture and read back asynchronously.

use crate::readback::{self, ReadBack};
use crate::renderer::Extent;
use crate::tiling::{
    BYTES_PER_PIXEL, MAX_PIXELS, MAX_SIDE, MOST_PIXELS, Tile, Tiling, Visible, check_picture,
    pixels_of_tiles, texture_size,
};
use crate::{Frame, RenderError, Renderer, Ticket};
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};
use wgpu::{
    Buffer, CommandEncoder, Device, Extent3d, PollType, Queue, SubmissionIndex, Texture, TextureFormat,
    TextureUsages, TextureView,
};

/// A texture to draw into, and buffers to read pictures back.
///
/// Up to [`Offscreen::FRAMES_IN_FLIGHT`] pictures can be submitted before the first is collected,
/// so that the GPU draws while the host simulates, encodes or writes.
///
/// Pictures of more than 9 million pixels, or larger than a texture of the device, are drawn in tiles. The result
/// is that of a picture in one piece; only single pixels at outlines differ by rounding. Submitting such a
/// picture waits for it.
#[derive(Debug)]
pub struct Offscreen {
    device: Device,
    queue: Queue,
    size: [u32; 2],
    /// Of the size of the picture, or of a tile with its border.
    texture: Texture,
    identity: u64,
    submitted: u64,
    free: Vec<Buffer>,
    in_flight: Vec<InFlight>,
    /// The picture that is being put together.
    begun: Option<Begun>,
    #[cfg(test)]
    border: Option<u32>,
}

/// Side of the textures that every device has: the default limit of WebGPU.
const LEAST_SIDE: u32 = 8192;

/// Memory for drawing pictures, in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct MemoryForecast {
    /// Of the host.
    pub host: u64,
    /// Of the device.
    pub device: u64,
}

#[derive(Debug)]
struct InFlight {
    number: u64,
    content: Content,
}

#[derive(Debug)]
enum Content {
    /// A picture in one piece.
    Reading(ReadBack),
    /// A picture of tiles.
    Complete(Vec<u8>),
}

/// A picture of which some tiles have been drawn.
#[derive(Debug)]
struct Begun {
    /// The tile to draw.
    tile: Tile,
    rgba: Vec<u8>,
}

impl Offscreen {
    /// Format of the texture; create the [`Renderer`] with the same format.
    pub const FORMAT: TextureFormat = TextureFormat::Rgba8UnormSrgb;
    /// Largest number of pictures that are submitted and not yet collected.
    pub const FRAMES_IN_FLIGHT: usize = 3;
    /// Largest width and height of a picture.
    pub const MAX_SIDE: u32 = MAX_SIDE;
    /// Largest number of pixels of a picture: with RGBA a picture then takes 1 GiB.
    pub const MAX_PIXELS: u64 = MAX_PIXELS;

    /// Creates a target of `size` (width, height) pixels.
    ///
    /// # Errors
    /// [`RenderError::PictureSize`] if a side is 0 or exceeds [`MAX_SIDE`](Self::MAX_SIDE),
    /// [`RenderError::TooManyPixels`] above [`MAX_PIXELS`](Self::MAX_PIXELS),
    /// [`RenderError::DeviceLost`] if the device is out of memory.
    pub fn new(device: &Device, queue: &Queue, size: [u32; 2]) -> Result<Offscreen, RenderError> {
        check_picture(size)?;
        let texture = texture_size(size, device.limits().max_texture_dimension_2d);
        Offscreen::with_texture(device, queue, size, texture)
    }

    /// Draws in tiles that fit into a texture of this size with their borders.
    pub(crate) fn with_texture(
        device: &Device,
        queue: &Queue,
        size: [u32; 2],
        texture: [u32; 2],
    ) -> Result<Offscreen, RenderError> {
        static IDENTITIES: AtomicU64 = AtomicU64::new(0);
        with_error_scopes(device, || {
            let identity = IDENTITIES.fetch_add(1, Ordering::Relaxed);
            Ok(Offscreen::allocate(device, queue, size, texture, identity))
        })
    }

    fn allocate(
        device: &Device,
        queue: &Queue,
        size: [u32; 2],
        [width, height]: [u32; 2],
        identity: u64,
    ) -> Offscreen {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("offscreen"),
            size: Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: Offscreen::FORMAT,
            usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        // Tiles are read back one by one.
        let buffers = if size == [width, height] { Offscreen::FRAMES_IN_FLIGHT } else { 1 };
        Offscreen {
            free: (0..buffers).map(|_| readback::buffer(device, [width, height])).collect(),
            device: device.clone(),
            queue: queue.clone(),
            size,
            texture,
            identity,
            submitted: 0,
            in_flight: Vec::new(),
            begun: None,
            #[cfg(test)]
            border: None,
        }
    }

    /// The memory for drawing pictures of this size. A picture is in memory three times: drawn, waiting to be written,
    /// and as a compressed file. On the device there are the textures of a tile, and for an interactive liquid the
    /// scenes of all and the distances of their bodies.
    pub fn memory_forecast([width, height]: [u32; 2]) -> MemoryForecast {
        let pixels = u64::from(width) * u64::from(height);
        let tile = pixels.min(MOST_PIXELS);
        // Four bytes of a scene, and two of a distance at half the resolution.
        let scenes = 9 * pixels_of_tiles([width, height], LEAST_SIDE) / 2;
        MemoryForecast { host: 12 * pixels, device: BYTES_PER_PIXEL * tile + scenes }
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
    /// [`RenderError::DeviceLost`] if the device is lost or out of memory,
    /// [`RenderError::PictureMemory`] if the host is, and the errors of [`Renderer::draw`].
    pub fn submit(&mut self, renderer: &mut Renderer, frame: &Frame<'_>) -> Result<Ticket, RenderError> {
        loop {
            if let Some(ticket) = self.submit_from(renderer, frame, 0)? {
                return Ok(ticket);
            }
        }
    }

    /// Submits some samples of a picture with [traced rays](Frame::with_tracing), which
    /// [`submit_from`](Self::submit_from) completes. The samples of a picture are drawn in order, and may show frames
    /// that differ by what moves while the shutter is open: see [`Quality::time`](crate::Quality::time). They are
    /// drawn of one tile only if the picture has several.
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
        let tile = self.begin(frame)?;
        let drawn = self.draw_samples(renderer, frame, tile, samples);
        self.forget_after(drawn)
    }

    /// Submits the samples of a picture from number `first` on, which complete it. Without traced rays a picture has only
    /// one.
    ///
    /// A large picture is drawn tile by tile: as long as the result is `None`, submit all samples again for the next
    /// tile.
    ///
    /// # Errors
    /// As [`submit`](Self::submit).
    pub fn submit_from(
        &mut self,
        renderer: &mut Renderer,
        frame: &Frame<'_>,
        first: u32,
    ) -> Result<Option<Ticket>, RenderError> {
        check_format(renderer)?;
        let tile = self.begin(frame)?;
        let submitted = self.complete(renderer, frame, tile, first);
        let read_back = self.forget_after(submitted)?;
        let Some(mut begun) = self.begun.take() else {
            return Ok(Some(self.issue(Content::Reading(read_back))));
        };
        let Visible { in_texture, in_picture, size } = tile.visible();
        let [from, until] = [in_texture[0], in_texture[0] + size[0]].map(|x| 4 * x as usize);
        let rows = in_texture[1] as usize..(in_texture[1] + size[1]) as usize;
        let buffer = read_back.wait(&self.device, tile.tiling.texture()[0], |number, row| {
            if rows.contains(&number) {
                let y = in_picture[1] as usize + number - rows.start;
                let start = 4 * (y * self.size[0] as usize + in_picture[0] as usize);
                begun.rgba[start..start + until - from].copy_from_slice(&row[from..until]);
            }
        })?;
        self.free.push(buffer);
        begun.tile.index += 1;
        if begun.tile.index == tile.tiling.count() {
            return Ok(Some(self.issue(Content::Complete(begun.rgba))));
        }
        self.begun = Some(begun);
        Ok(None)
    }

    /// The tile to draw.
    fn begin(&mut self, frame: &Frame<'_>) -> Result<Tile, RenderError> {
        if self.in_flight.len() >= Offscreen::FRAMES_IN_FLIGHT {
            return Err(RenderError::FramesInFlight { limit: Offscreen::FRAMES_IN_FLIGHT });
        }
        if let Some(begun) = &self.begun {
            return Ok(begun.tile);
        }
        let Extent3d { width, height, .. } = self.texture.size();
        if [width, height] == self.size {
            return Ok(Tile::whole(self.size));
        }
        let tiling = Tiling::new(self.size, [width, height], frame.border(self.size)?);
        #[cfg(test)]
        let tiling = match self.border {
            Some(border) => Tiling::with_border(self.size, [width, height], border),
            None => tiling,
        };
        let tile = Tile { tiling, index: 0 };
        self.begun = Some(Begun { tile, rgba: pixels(self.size)? });
        Ok(tile)
    }

    /// After an error the next submission begins a picture.
    fn forget_after<T>(&mut self, result: Result<T, RenderError>) -> Result<T, RenderError> {
        if result.is_err() {
            self.begun = None;
        }
        result
    }

    fn draw_samples(
        &self,
        renderer: &mut Renderer,
        frame: &Frame<'_>,
        tile: Tile,
        samples: Range<u32>,
    ) -> Result<(), RenderError> {
        with_error_scopes(&self.device, || {
            // A submission per sample: drivers stop those that take seconds.
            for sample in samples {
                let mut encoder = self.encoder();
                let range = sample..sample + 1;
                renderer.draw_samples(&mut encoder, &self.view(), tile, frame, range)?;
                self.execute(renderer, encoder)?;
            }
            Ok(())
        })
    }

    /// Draws what is left of a tile and starts to read it back.
    fn complete(
        &mut self,
        renderer: &mut Renderer,
        frame: &Frame<'_>,
        tile: Tile,
        first: u32,
    ) -> Result<ReadBack, RenderError> {
        let Some(buffer) = self.free.last().cloned() else {
            return Err(RenderError::FramesInFlight { limit: Offscreen::FRAMES_IN_FLIGHT });
        };
        let last = frame.traced_samples().map(|samples| samples.saturating_sub(1));
        match last {
            Some(last) => self.draw_samples(renderer, frame, tile, first..last)?,
            None if tile.index == 0 => self.draw_scenes(renderer, frame, tile.tiling)?,
            None => {}
        }
        let submission = with_error_scopes(&self.device, || {
            let (view, mut encoder) = (self.view(), self.encoder());
            match last {
                None => renderer.draw_tile(&mut encoder, &view, tile, frame, Extent::All)?,
                Some(last) => renderer.draw_samples(&mut encoder, &view, tile, frame, last..last + 1)?,
            }
            readback::record(&mut encoder, &self.texture, &buffer);
            self.execute(renderer, encoder)
        })?;
        self.free.pop();
        Ok(ReadBack::start(buffer, submission))
    }

    /// Draws what is behind liquid and droplets in all tiles, because refraction reads it anywhere.
    fn draw_scenes(
        &self,
        renderer: &mut Renderer,
        frame: &Frame<'_>,
        tiling: Tiling,
    ) -> Result<(), RenderError> {
        if tiling.count() == 1 || !frame.is_refracted() {
            return Ok(());
        }
        with_error_scopes(&self.device, || {
            for tile in tiling.tiles() {
                let mut encoder = self.encoder();
                renderer.draw_tile(&mut encoder, &self.view(), tile, frame, Extent::BehindLiquid)?;
                self.execute(renderer, encoder)?;
            }
            Ok(())
        })
    }

    /// Submits commands. If passes are measured it waits for them, because the timer leaves out those that are recorded
    /// while several have not been executed.
    fn execute(&self, renderer: &Renderer, encoder: CommandEncoder) -> Result<SubmissionIndex, RenderError> {
        let submission = self.queue.submit([encoder.finish()]);
        if renderer.is_timed() {
            let waiting = PollType::Wait { submission_index: Some(submission.clone()), timeout: None };
            let lost = |error: wgpu::PollError| RenderError::DeviceLost { reason: error.to_string() };
            self.device.poll(waiting).map_err(lost)?;
        }
        Ok(submission)
    }

    fn issue(&mut self, content: Content) -> Ticket {
        let number = self.submitted;
        self.submitted += 1;
        self.in_flight.push(InFlight { number, content });
        Ticket { target: self.identity, number }
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
    /// if the device was lost, [`RenderError::PictureMemory`] if the host is out of memory.
    pub fn collect(&mut self, ticket: Ticket) -> Result<Vec<u8>, RenderError> {
        let index = self.in_flight.iter().position(|picture| picture.number == ticket.number);
        let Some(index) = index.filter(|_| ticket.target == self.identity) else {
            return Err(RenderError::UnknownTicket { ticket });
        };
        match self.in_flight.remove(index).content {
            Content::Complete(rgba) => Ok(rgba),
            Content::Reading(read_back) => {
                let mut rgba = pixels(self.size)?;
                let mut rows = rgba.chunks_exact_mut(4 * self.size[0] as usize);
                let buffer = read_back.wait(&self.device, self.size[0], |_, row| {
                    if let Some(own) = rows.next() {
                        own.copy_from_slice(row);
                    }
                })?;
                self.free.push(buffer);
                Ok(rgba)
            }
        }
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

/// An RGBA picture of zeros.
fn pixels([width, height]: [u32; 2]) -> Result<Vec<u8>, RenderError> {
    let bytes = 4 * width as usize * height as usize;
    let mut rgba = Vec::new();
    rgba.try_reserve_exact(bytes).map_err(|_| RenderError::PictureMemory { width, height })?;
    rgba.resize(bytes, 0);
    Ok(rgba)
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

#[cfg(test)]
mod tests;
