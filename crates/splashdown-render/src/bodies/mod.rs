//! Solids that the liquid meets.
//!
//! # How it works
//! The meshes of all solids come as one mesh in world space, with a colour per vertex. They are drawn into the
//! picture before particles and liquid, so that the liquid's shader finds them behind itself and bends and
//! tints them, and their depth hides what lies behind. For the tint the thickness of liquid must end at the
//! solid: its distance is drawn into a texture of its own, the least one kept, and the thickness pass cuts
//! every distance off there.
//!
//! # Why not the other way
//! Transforming on the GPU would save an upload of some thousand vertices per frame and need a draw per solid.
//!
//! # Things we might try
//! Shadows on solids and on the water; caustics on them.

use crate::pipeline::{Depth, Recipe};
use crate::shader::{ENVIRONMENT, GLOBALS, Shader};
use crate::targets::THICKNESS_FORMAT;
use crate::{BodyBuffers, Draw};
use wgpu::{
    BindGroupLayout, BlendComponent, BlendFactor, BlendOperation, BlendState, Device, IndexFormat,
    RenderPass, RenderPipeline, TextureFormat,
};

pub(crate) const SHADER: Shader =
    Shader { label: "bodies", parts: &[GLOBALS, ENVIRONMENT, include_str!("bodies.wgsl")] };
pub(crate) const DISTANCE: Shader =
    Shader { label: "distance of bodies", parts: &[GLOBALS, include_str!("distance.wgsl")] };

/// Keeps the least of what is drawn.
const LEAST: BlendState = {
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
        let recipe = Recipe {
            samples,
            depth: Some(Depth::TestAndWrite),
            vertex_buffers: 3,
            ..Recipe::new(SHADER, &layouts, format)
        };
        let distance_layouts = [globals];
        let distance = Recipe {
            blend: Some(LEAST),
            vertex_buffers: 1,
            ..Recipe::new(DISTANCE, &distance_layouts, THICKNESS_FORMAT)
        };
        Bodies { pipeline: recipe.build(device), distance: distance.build(device) }
    }

    /// Groups 0 (globals) and 1 (environment) are set.
    pub fn record(&self, pass: &mut RenderPass<'_>, buffers: &BodyBuffers<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_vertex_buffer(1, buffers.normals.slice(..));
        pass.set_vertex_buffer(2, buffers.colours.slice(..));
        draw(pass, buffers);
    }

    /// Group 0 (globals) is set.
    pub fn record_distance(&self, pass: &mut RenderPass<'_>, buffers: &BodyBuffers<'_>) {
        pass.set_pipeline(&self.distance);
        draw(pass, buffers);
    }
}

/// Draws the mesh with its vertices in slot 0.
pub(crate) fn draw(pass: &mut RenderPass<'_>, buffers: &BodyBuffers<'_>) {
    pass.set_vertex_buffer(0, buffers.vertices.slice(..));
    pass.set_index_buffer(buffers.indices.slice(..), IndexFormat::Uint32);
    if let Draw::Direct { index_count } = buffers.draw {
        pass.draw_indexed(0..index_count, 0, 0..1);
    }
}
