//! The surface of the liquid from a mesh.
//!
//! # How it works
//! The colour of a pixel combines three parts.
//!
//! * *Reflection*: the reflected ray samples the same procedural environment as the background.
//! * *Refraction*: the walls of the tank are known, so that a ray that meets one inside the liquid is
//!   refracted there or reflected totally, up to three times. Where the view ray ends at a body or at the
//!   bottom, the refracted one is followed to the body that it meets, whose distance is known in every
//!   pixel, or to the side of the box, and shows a texture with the picture without the liquid there.
//!   Where that place is hidden, the floor is computed. Elsewhere the ray leaves through a free
//!   surface, whose normal follows from the thickness in the pixels around, and is refracted again.
//!   Light is absorbed along the path (Beer-Lambert), and the liquid's own colour increases with depth.
//! * *Fresnel*: the exact equations for a dielectric and unpolarised light weight the two. A rough
//!   highlight of the sun (GGX, Walter et al. 2007) is added.
//!
//! The length of the view ray inside the liquid is summed beforehand at half resolution: by
//! blending, back faces add their distance from the eye and front faces subtract it, in any order.
//! In a closed mesh a constant cancels, so the distance of the middle of the box is subtracted
//! first; 16-bit floats are then precise to about a millimetre per metre.
//!
//! A pass stores normals and depths of the mesh; each pixel is shaded afterwards (module `deferred`).
//!
//! *Wireframe*: WebGPU only fills triangles. The vertex shader loads each corner by its index and
//! outputs barycentric coordinates; these, divided by their gradient on the screen, are the
//! distances to the three edges in pixels. The lines of small triangles are fainter; otherwise a
//! fine mesh would be black.
//!
//! # Why not the other way
//! Without the second refraction a jet in the air is invisible: it shows what is behind it.
//! Ray tracing the mesh would be correct for drops in front of drops, but is too slow without a
//! GPU. Depth peeling needs a pass per layer. Here only the nearest layer is shaded; the layers
//! behind it contribute to the sum.

pub(crate) mod deferred;

use crate::globals::Globals;
use crate::pipeline::{ADD, Bind, Depth, OVER, PipelineDesc, bind_group, bind_group_layout};
use crate::recorder::Recorder;
use crate::shader::{ENVIRONMENT, EYE_DISTANCE, GLOBALS, Shader};
use crate::targets::{THICKNESS_FORMAT, Targets};
use crate::{Draw, Liquid, RenderError, SurfaceBuffers, SurfaceStyle};
use deferred::Deferred;
use wgpu::{
    BindGroup, BindGroupLayout, BindingResource, Color, Device, Face, RenderPass, RenderPipeline,
    TextureFormat, TextureView,
};

pub(crate) const THICKNESS: Shader =
    Shader { label: "thickness", parts: &[GLOBALS, EYE_DISTANCE, include_str!("thickness.wgsl")] };
pub(crate) const LINES: Shader =
    Shader { label: "lines", parts: &[GLOBALS, ENVIRONMENT, include_str!("lines.wgsl")] };

/// The surface of a liquid, drawn from a mesh.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct DrawnSurface<'a> {
    /// The mesh.
    pub buffers: SurfaceBuffers<'a>,
    /// Optical properties of the liquid.
    pub liquid: Liquid,
    /// Whether the liquid, the wireframe or both are drawn.
    pub style: SurfaceStyle,
}

impl<'a> DrawnSurface<'a> {
    /// A liquid without wireframe.
    pub fn new(buffers: SurfaceBuffers<'a>, liquid: Liquid) -> DrawnSurface<'a> {
        DrawnSurface { buffers, liquid, style: SurfaceStyle::Liquid }
    }

    /// The same in another style.
    #[must_use]
    pub fn with_style(self, style: SurfaceStyle) -> DrawnSurface<'a> {
        DrawnSurface { style, ..self }
    }

    /// Checks the values and writes the uniforms.
    pub(crate) fn fill(&self, globals: &mut Globals) -> Result<(), RenderError> {
        self.buffers.check()?;
        self.liquid.fill(globals)
    }
}

#[derive(Debug)]
pub(crate) struct Surface {
    deferred: Deferred,
    thickness: RenderPipeline,
    lines_over: RenderPipeline,
    lines_alone: RenderPipeline,
    lines_layout: BindGroupLayout,
    solid_layout: BindGroupLayout,
}

impl Surface {
    pub fn new(
        device: &Device,
        [globals, environment]: [&BindGroupLayout; 2],
        format: TextureFormat,
        samples: u32,
    ) -> Surface {
        let solid_layout = bind_group_layout(device, "solid", &[Bind::Texture]);
        let thickness_layouts = [globals, &solid_layout];
        let thickness = PipelineDesc {
            blend: Some(ADD),
            vertex_buffers: 1,
            ..PipelineDesc::new(THICKNESS, &thickness_layouts, THICKNESS_FORMAT)
        };
        let lines_layout = bind_group_layout(device, "lines", &[Bind::Storage, Bind::Storage]);
        let lines_layouts = [globals, environment, &lines_layout];
        let lines = |over: bool| {
            let constants = [("OVER_SURFACE", if over { 1.0 } else { 0.0 })];
            let desc = PipelineDesc {
                samples,
                depth: Some(Depth::Test),
                blend: Some(OVER),
                cull: over.then_some(Face::Back),
                constants: &constants,
                ..PipelineDesc::new(LINES, &lines_layouts, format)
            };
            desc.build(device)
        };
        Surface {
            lines_over: lines(true),
            lines_alone: lines(false),
            deferred: Deferred::new(device, [globals, environment], format, samples),
            thickness: thickness.build(device),
            lines_layout,
            solid_layout,
        }
    }

    /// Draws the liquid over the scene, and its depths: into the samples of `targets`, or with one
    /// sample per pixel into `picture`. `groups`: globals and environment.
    pub fn record(
        &self,
        device: &Device,
        recorder: &mut Recorder<'_>,
        targets: &Targets,
        picture: &TextureView,
        groups: [&BindGroup; 2],
        buffers: &SurfaceBuffers<'_>,
    ) {
        // Sums the thickness of the liquid on every view ray.
        {
            let mut pass = recorder.cleared("thickness", &targets.thickness, Color::TRANSPARENT);
            let solid = [BindingResource::TextureView(&targets.solid)];
            let group = bind_group(device, "solid", &self.solid_layout, &solid);
            pass.set_pipeline(&self.thickness);
            pass.set_bind_group(0, groups[0], &[]);
            pass.set_bind_group(1, &group, &[]);
            buffers.draw(&mut pass);
        }
        self.deferred.record(device, recorder, targets, picture, groups, buffers);
    }

    /// Draws the wireframe. Expects groups 0 (globals) and 1 (environment) to be bound.
    pub fn record_lines(&self, device: &Device, pass: &mut RenderPass<'_>, drawn: &DrawnSurface<'_>) {
        let pipeline = match drawn.style {
            SurfaceStyle::Liquid => return,
            SurfaceStyle::LiquidWithLines => &self.lines_over,
            SurfaceStyle::Lines => &self.lines_alone,
        };
        let resources =
            [drawn.buffers.vertices.as_entire_binding(), drawn.buffers.indices.as_entire_binding()];
        let group = bind_group(device, "lines", &self.lines_layout, &resources);
        pass.set_pipeline(pipeline);
        pass.set_bind_group(2, &group, &[]);
        match drawn.buffers.draw {
            Draw::Direct { index_count } => pass.draw(0..index_count, 0..1),
            // The arguments of an indexed draw are read as those of a non-indexed one: the index
            // count becomes the vertex count, the first index the first vertex, and the base vertex
            // (0) the first instance.
            Draw::Indirect(arguments, offset) => pass.draw_indirect(arguments, offset),
        }
    }
}
