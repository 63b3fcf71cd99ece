//! Colour bar and caption, drawn over the finished picture.
//!
//! # How it works
//! Each is drawn on the host into a small image ([`Canvas`]) when its content changes, uploaded
//! into a new texture and drawn as a quad with one texel per pixel. Pictures in flight keep their
//! old texture.
//!
//! # Why not the other way
//! A glyph atlas with a quad per character would save an upload of about 100 KB when a caption
//! changes, which takes less than a millisecond, and would need an atlas, its packing and a layout
//! pass. Multisampled text would be blurred.
//!
//! # Things we might try
//! A scale bar with the length of the scene.

mod canvas;
mod colour_bar;
mod ticks;

use crate::pipeline::{Bind, OVER, PipelineDesc, bind_group, bind_group_layout};
use crate::recorder::Recorder;
use crate::shader::Shader;
use crate::texture::upload_texture;
use crate::tiling::Tile;
use crate::{Frame, RenderError};
use bytemuck::{Pod, Zeroable};
use canvas::Canvas;
pub use canvas::missing_characters;
use wgpu::{
    BindGroup, BindGroupLayout, BindingResource, BufferUsages, Device, PrimitiveTopology, Queue,
    RenderPipeline, TextureFormat, TextureView,
};

pub(crate) const SHADER: Shader = Shader { label: "overlay", parts: &[include_str!("overlay.wgsl")] };

#[derive(Debug)]
pub(crate) struct Overlay {
    pipeline: RenderPipeline,
    layout: BindGroupLayout,
    encode_srgb: bool,
    colour_bar: Option<Label>,
    caption: Option<Label>,
}

/// A labelled rectangle on the GPU.
#[derive(Debug)]
struct Label {
    /// Text and size of the picture; when this changes the label is redrawn.
    content: String,
    /// Absent if the picture is too small for the label.
    image: Option<Image>,
    /// The tile of `group`.
    tile: Tile,
    group: Option<BindGroup>,
}

/// What is drawn of a label.
#[derive(Debug)]
struct Image {
    /// Pixels from the upper left of the picture.
    corner: [u32; 2],
    size: [u32; 2],
    texture: TextureView,
}

/// Mirrors `Placement` in overlay.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct Placement {
    corner: [f32; 2],
    size: [f32; 2],
    target_size: [f32; 2],
    encode_srgb: u32,
    pad: u32,
}

impl Overlay {
    pub fn new(device: &Device, format: TextureFormat) -> Overlay {
        let layout = bind_group_layout(device, "overlay", &[Bind::Uniform, Bind::Texture]);
        let layouts = [&layout];
        let desc = PipelineDesc {
            blend: Some(OVER),
            topology: PrimitiveTopology::TriangleStrip,
            ..PipelineDesc::new(SHADER, &layouts, format)
        };
        let pipeline = desc.build(device);
        Overlay { pipeline, layout, encode_srgb: !format.is_srgb(), colour_bar: None, caption: None }
    }

    /// Redraws the labels that have changed since the last picture.
    pub fn prepare(
        &mut self,
        device: &Device,
        queue: &Queue,
        tile: Tile,
        frame: &Frame<'_>,
    ) -> Result<(), RenderError> {
        let size = tile.tiling.picture();
        let colourings =
            [frame.particles.map(|drawn| drawn.colouring), frame.slice.map(|drawn| drawn.colouring)];
        let colouring = colourings.into_iter().flatten().find(|colouring| colouring.colour_bar);
        let bar = match &colouring {
            Some(colouring) => Some((format!("{size:?} {colouring:?}"), colouring.checked_range()?)),
            None => None,
        };
        let caption = frame.caption.filter(|text| !text.is_empty());

        let old = self.colour_bar.take();
        self.colour_bar = bar.zip(colouring).map(|((content, range), colouring)| {
            let draw = || colour_bar::draw_colour_bar(&colouring, range, size);
            self.reuse_or_draw(device, queue, tile, old, content, draw)
        });
        let old = self.caption.take();
        self.caption = caption.map(|text| {
            let content = format!("{size:?} {text}");
            self.reuse_or_draw(device, queue, tile, old, content, || colour_bar::draw_caption(text, size))
        });
        Ok(())
    }

    fn reuse_or_draw(
        &self,
        device: &Device,
        queue: &Queue,
        tile: Tile,
        old: Option<Label>,
        content: String,
        draw: impl FnOnce() -> Option<([u32; 2], Canvas)>,
    ) -> Label {
        let image = match old {
            Some(old) if old.content == content && old.tile == tile => return old,
            Some(old) if old.content == content => old.image,
            _ => draw().map(|(corner, canvas)| {
                let texture = upload_texture(device, queue, "overlay", canvas.size(), canvas.bytes());
                Image { corner, size: canvas.size(), texture }
            }),
        };
        let group = image.as_ref().map(|image| self.place(device, queue, tile, image));
        Label { content, image, tile, group }
    }

    /// Binds an image at its place in the target.
    fn place(&self, device: &Device, queue: &Queue, tile: Tile, image: &Image) -> BindGroup {
        let corner = tile.corner();
        let placement = Placement {
            corner: [0, 1].map(|axis: usize| image.corner[axis] as f32 - corner[axis]),
            size: image.size.map(|x| x as f32),
            target_size: tile.tiling.texture().map(|x| x as f32),
            encode_srgb: u32::from(self.encode_srgb),
            pad: 0,
        };
        let uniform = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("overlay placement"),
            size: size_of::<Placement>() as u64,
            usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        queue.write_buffer(&uniform, 0, bytemuck::bytes_of(&placement));
        let resources = [uniform.as_entire_binding(), BindingResource::TextureView(&image.texture)];
        bind_group(device, "overlay", &self.layout, &resources)
    }

    /// Draws the labels over the finished picture.
    pub fn record(&self, recorder: &mut Recorder<'_>, target: &TextureView) {
        let groups: Vec<&BindGroup> = [&self.colour_bar, &self.caption]
            .into_iter()
            .flatten()
            .filter_map(|label| label.group.as_ref())
            .collect();
        if groups.is_empty() {
            return;
        }
        let mut pass = recorder.over("overlay", target);
        pass.set_pipeline(&self.pipeline);
        for group in groups {
            pass.set_bind_group(0, group, &[]);
            pass.draw(0..4, 0..1);
        }
    }
}
