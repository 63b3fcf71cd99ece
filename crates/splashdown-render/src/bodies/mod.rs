//! The solid bodies of a scene.
//!
//! # How it works
//! The meshes of all bodies form one mesh in world space, with a colour per vertex. They are drawn
//! before particles and liquid, so that the shader of the liquid refracts and tints them, and their
//! depth hides what lies behind. The thickness of the liquid must end at a body: the distance of
//! the nearest body is drawn into a texture with minimum blending, and the thickness pass clamps
//! every distance to it.
//!
//! # Why not the other way
//! Transforming the vertices on the GPU would save an upload of a few thousand vertices per frame,
//! but would need one draw per body.
//!
//! # Things we might try
//! Caustics on bodies.

mod meshes;

use crate::BodyBuffers;
use crate::pipeline::{Depth, PipelineDesc};
use crate::shader::{ENVIRONMENT, EYE_DISTANCE, GLOBALS, LIT, MATTE, SUN_LAYERS, SUNLIT, Shader, TRACE};
use crate::targets::THICKNESS_FORMAT;
use wgpu::{
    BindGroupLayout, BlendComponent, BlendFactor, BlendOperation, BlendState, Device, RenderPass,
    RenderPipeline, TextureFormat,
};

pub use meshes::{PlacedBody, UploadedBodies};

pub(crate) const SHADER: Shader =
    Shader { label: "bodies", parts: &[GLOBALS, ENVIRONMENT, LIT, MATTE, include_str!("bodies.wgsl")] };
/// With shadows of bodies and light through liquid on bodies, by rays through the trees in group 2.
pub(crate) const TRACED: Shader = Shader {
    label: "bodies in shadow",
    parts: &[GLOBALS, ENVIRONMENT, TRACE, SUN_LAYERS, SUNLIT, MATTE, include_str!("bodies.wgsl")],
};
pub(crate) const DISTANCE: Shader =
    Shader { label: "distance of bodies", parts: &[GLOBALS, EYE_DISTANCE, include_str!("distance.wgsl")] };

/// Blending that stores the minimum.
const MINIMUM: BlendState = {
    let component = BlendComponent {
        src_factor: BlendFactor::One,
        dst_factor: BlendFactor::One,
        operation: BlendOperation::Min,
    };
    BlendState { color: component, alpha: component }
};

#[derive(Debug)]
pub(crate) struct Bodies {
    pipeline: RenderPipeline,
    distance: RenderPipeline,
}

impl Bodies {
    pub fn new(
        device: &Device,
        [globals, environment]: [&BindGroupLayout; 2],
        format: TextureFormat,
        samples: u32,
    ) -> Bodies {
        let layouts = [globals, environment];
        let pipeline = pipeline(device, SHADER, &layouts, format, samples);
        let distance_layouts = [globals];
        let distance = PipelineDesc {
            blend: Some(MINIMUM),
            vertex_buffers: 1,
            ..PipelineDesc::new(DISTANCE, &distance_layouts, THICKNESS_FORMAT)
        };
        Bodies { pipeline, distance: distance.build(device) }
    }

    /// Draws the bodies. Expects groups 0 (globals) and 1 (environment) to be bound.
    pub fn record(&self, pass: &mut RenderPass<'_>, buffers: &BodyBuffers<'_>) {
        record(&self.pipeline, pass, buffers);
    }

    /// Draws the distances of the bodies. Expects group 0 (globals) to be bound.
    pub fn record_distance(&self, pass: &mut RenderPass<'_>, buffers: &BodyBuffers<'_>) {
        pass.set_pipeline(&self.distance);
        buffers.draw(pass);
    }
}

/// A pipeline that draws bodies.
pub(crate) fn pipeline(
    device: &Device,
    shader: Shader,
    layouts: &[&BindGroupLayout],
    format: TextureFormat,
    samples: u32,
) -> RenderPipeline {
    let depth = Some(Depth::TestAndWrite);
    let desc = PipelineDesc::new(shader, layouts, format);
    PipelineDesc { samples, depth, vertex_buffers: 3, ..desc }.build(device)
}

/// Draws bodies with a pipeline. Expects its groups to be bound.
pub(crate) fn record(pipeline: &RenderPipeline, pass: &mut RenderPass<'_>, buffers: &BodyBuffers<'_>) {
    pass.set_pipeline(pipeline);
    pass.set_vertex_buffer(1, buffers.normals.slice(..));
    pass.set_vertex_buffer(2, buffers.colours.slice(..));
    buffers.draw(pass);
}
