//! Deferred shading of a mesh.
//!
//! # How it works
//! 1. *Normals*: the mesh is drawn with a short fragment shader, which stores the normal of every
//!    sample as two 16-bit integers. The depths of the nearest layer go into the depth buffer of the
//!    picture, against which all later passes test.
//! 2. *Cover*: a depth buffer with one sample per pixel marks the pixels that contain liquid.
//! 3. *Shade*: one triangle covers the picture; the marks exclude pixels without liquid before their
//!    shader runs. Samples of a pixel that agree in normal and depth are averaged and shaded once. At
//!    an outline in front of other liquid, or where the surface is strongly curved, a pixel contains
//!    several groups of samples. Each is shaded, and the colours are averaged.
//! 4. *Over samples*: the colour is written into those samples of the picture that the liquid covers.
//!    Outlines are therefore as smooth as those of triangles. With one sample per pixel, the third
//!    pass draws into the picture, and there is no fourth.
//!
//! The textures take 24 bytes per pixel with four samples per pixel and 8 with one, from the first
//! mesh on.
//!
//! Measured with lavapipe (Mesa 22.3.6) on two cores at 1280 x 720 with four samples, the surface of a
//! dam break with 231,000 triangles: normals 49 ms, cover 6, shade 36, over samples 16. The shader of
//! the liquid in the pass of the mesh took about 350 ms.
//!
//! # Why not the other way
//! The shader of the liquid in the pass of the mesh runs once for each triangle in a pixel, which is
//! three to four with cells of half a spacing, and for layers that are covered later. A software
//! driver even runs it for all 16 pixels of a block that a triangle touches.
//!
//! Normals as resolved 16-bit floats need twice the memory, and the average of two layers of liquid
//! in a pixel is a normal of neither. Integers cannot be resolved, but samples can be loaded one by
//! one.
//!
//! Shading directly into several samples per pixel saves the fourth pass and its texture, but on a
//! software driver the early depth test then saves nothing.
//!
//! # Things we might try
//! Reflections in screen space: normals and depths of the whole picture are known.

use crate::SurfaceBuffers;
use crate::pipeline::{Bind, Depth, PipelineDesc, bind_group, bind_group_layout, linear_sampler};
use crate::recorder::Recorder;
use crate::shader::{ENVIRONMENT, FULLSCREEN, GLOBALS, LIQUID, OPTICS, PICTURE_BEHIND, Shader};
use crate::targets::{NORMAL_FORMAT, Targets};
use wgpu::{
    BindGroup, BindGroupLayout, BindingResource, Device, Face, RenderPipeline, Sampler, TextureFormat,
    TextureView,
};

const NORMAL_CODE: &str = include_str!("normal_code.wgsl");
const ONE_SAMPLE: &str = include_str!("one_sample.wgsl");
const FOUR_SAMPLES: &str = include_str!("four_samples.wgsl");
const STORED: &str = include_str!("stored.wgsl");
const COVER: &str = include_str!("cover.wgsl");
const SHADE: &str = include_str!("shade.wgsl");

pub(crate) const NORMALS: Shader =
    Shader { label: "normals", parts: &[GLOBALS, NORMAL_CODE, include_str!("normals.wgsl")] };
pub(crate) const COVER_ONE: Shader =
    Shader { label: "cover", parts: &[FULLSCREEN, NORMAL_CODE, ONE_SAMPLE, STORED, COVER] };
pub(crate) const COVER_FOUR: Shader =
    Shader { label: "cover", parts: &[FULLSCREEN, NORMAL_CODE, FOUR_SAMPLES, STORED, COVER] };
pub(crate) const SHADE_ONE: Shader = Shader {
    label: "shade",
    parts: &[
        GLOBALS,
        FULLSCREEN,
        ENVIRONMENT,
        OPTICS,
        PICTURE_BEHIND,
        LIQUID,
        NORMAL_CODE,
        ONE_SAMPLE,
        STORED,
        SHADE,
    ],
};
pub(crate) const SHADE_FOUR: Shader = Shader {
    label: "shade",
    parts: &[
        GLOBALS,
        FULLSCREEN,
        ENVIRONMENT,
        OPTICS,
        PICTURE_BEHIND,
        LIQUID,
        NORMAL_CODE,
        FOUR_SAMPLES,
        STORED,
        SHADE,
    ],
};
pub(crate) const OVER_SAMPLES: Shader = Shader {
    label: "over samples",
    parts: &[FULLSCREEN, NORMAL_CODE, FOUR_SAMPLES, STORED, include_str!("over_samples.wgsl")],
};

#[derive(Debug)]
pub(crate) struct Deferred {
    normals: RenderPipeline,
    cover: RenderPipeline,
    shade: RenderPipeline,
    /// With several samples per pixel.
    over_samples: Option<RenderPipeline>,
    behind_layout: BindGroupLayout,
    stored_layout: BindGroupLayout,
    liquid_layout: BindGroupLayout,
    sampler: Sampler,
}

impl Deferred {
    pub fn new(
        device: &Device,
        [globals, environment]: [&BindGroupLayout; 2],
        format: TextureFormat,
        samples: u32,
    ) -> Deferred {
        let multisampled = samples > 1;
        let behind_bindings = [Bind::TextureLayers, Bind::Texture, Bind::Sampler, Bind::TextureLayers];
        let behind_layout = bind_group_layout(device, "behind the liquid", &behind_bindings);
        let stored_bindings = [Bind::Integers { multisampled }, Bind::Depths { multisampled }];
        let stored_layout = bind_group_layout(device, "stored surface", &stored_bindings);
        let liquid_layout = bind_group_layout(device, "shaded liquid", &[Bind::Texels]);
        let normals_layouts = [globals];
        let normals = PipelineDesc {
            samples,
            depth: Some(Depth::TestAndWrite),
            cull: Some(Face::Back),
            vertex_buffers: 2,
            ..PipelineDesc::new(NORMALS, &normals_layouts, NORMAL_FORMAT)
        };
        let (cover, shade) = if multisampled { (COVER_FOUR, SHADE_FOUR) } else { (COVER_ONE, SHADE_ONE) };
        let layouts = [globals, environment, &behind_layout, &stored_layout];
        let cover = PipelineDesc { depth: Some(Depth::Write), ..PipelineDesc::new(cover, &layouts, None) };
        let shade = PipelineDesc { depth: Some(Depth::Test), ..PipelineDesc::new(shade, &layouts, format) };
        let layouts = [globals, environment, &liquid_layout, &stored_layout];
        let over_samples = PipelineDesc { samples, ..PipelineDesc::new(OVER_SAMPLES, &layouts, format) };
        Deferred {
            normals: normals.build(device),
            cover: cover.build(device),
            shade: shade.build(device),
            over_samples: multisampled.then(|| over_samples.build(device)),
            sampler: linear_sampler(device),
            behind_layout,
            stored_layout,
            liquid_layout,
        }
    }

    /// Draws the liquid over the scene in the samples of `targets`, or in `picture` with one sample
    /// per pixel, and its depths. `groups`: globals and environment.
    pub fn record(
        &self,
        device: &Device,
        recorder: &mut Recorder<'_>,
        targets: &Targets,
        picture: &TextureView,
        groups: [&BindGroup; 2],
        buffers: &SurfaceBuffers<'_>,
    ) {
        let Some(mesh) = &targets.mesh else { return };
        {
            let mut pass = recorder.over_depth("normals", &mesh.normals, &targets.depth);
            pass.set_pipeline(&self.normals);
            pass.set_bind_group(0, groups[0], &[]);
            pass.set_vertex_buffer(1, buffers.normals.slice(..));
            buffers.draw(&mut pass);
        }
        let behind = [
            BindingResource::TextureView(&targets.scenes.view),
            BindingResource::TextureView(&targets.thickness),
            BindingResource::Sampler(&self.sampler),
            BindingResource::TextureView(&targets.solids.view),
        ];
        let behind = bind_group(device, "behind the liquid", &self.behind_layout, &behind);
        let stored = [&mesh.normals, &targets.depth].map(BindingResource::TextureView);
        let stored = bind_group(device, "stored surface", &self.stored_layout, &stored);
        let full_screen = |mut pass: wgpu::RenderPass<'_>, pipeline, group: &BindGroup| {
            pass.set_pipeline(pipeline);
            for (index, group) in (0..).zip([groups[0], groups[1], group, &stored]) {
                pass.set_bind_group(index, group, &[]);
            }
            pass.draw(0..3, 0..1);
        };
        full_screen(recorder.marks("cover", &mesh.covered), &self.cover, &behind);
        let shaded = mesh.liquid.as_ref().unwrap_or(picture);
        full_screen(recorder.over_marks("shade", shaded, &mesh.covered), &self.shade, &behind);
        if let (Some(pipeline), Some(liquid), Some(samples)) =
            (&self.over_samples, &mesh.liquid, &targets.samples)
        {
            let liquid = [BindingResource::TextureView(liquid)];
            let liquid = bind_group(device, "shaded liquid", &self.liquid_layout, &liquid);
            full_screen(recorder.over("over samples", samples), pipeline, &liquid);
        }
    }
}
