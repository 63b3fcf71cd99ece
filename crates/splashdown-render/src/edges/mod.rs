//! The edges of the box as thin lines.
//!
//! # How it works
//! Each edge is a quad that the vertex shader expands on the screen to a constant width in pixels,
//! plus one pixel on each side over which it fades. Lines are therefore smooth with and without
//! multisampling. Edges that fluid in the box can hide are those whose two walls face the eye with
//! their inside. They are drawn before the fluid, which then reflects and refracts them like the
//! floor. All other edges lie on the near side of the convex box and are drawn last. So every edge
//! is drawn once.
//!
//! # Why not the other way
//! WebGPU line primitives are always one pixel wide. Drawing all edges before and again after the
//! fluid would darken those that do not touch it.
//!
//! # Things we might try
//! Glass: faint reflections on the front walls.

use crate::pipeline::{Depth, OVER, PipelineDesc};
use crate::shader::{GLOBALS, Shader};
use std::ops::Range;
use wgpu::{BindGroupLayout, Device, PrimitiveTopology, RenderPass, RenderPipeline, TextureFormat};

pub(crate) const SHADER: Shader = Shader { label: "edges", parts: &[GLOBALS, include_str!("edges.wgsl")] };

#[derive(Debug)]
pub(crate) struct Edges {
    pipeline: RenderPipeline,
}

impl Edges {
    pub fn new(
        device: &Device,
        layouts: [&BindGroupLayout; 1],
        format: TextureFormat,
        samples: u32,
    ) -> Edges {
        let desc = PipelineDesc {
            samples,
            depth: Some(Depth::Test),
            blend: Some(OVER),
            topology: PrimitiveTopology::TriangleStrip,
            ..PipelineDesc::new(SHADER, &layouts, format)
        };
        Edges { pipeline: desc.build(device) }
    }

    /// Draws some of the twelve edges. Expects group 0 (globals) to be bound.
    pub fn record(&self, pass: &mut RenderPass<'_>, edges: Range<u32>) {
        pass.set_pipeline(&self.pipeline);
        pass.draw(0..4, edges);
    }
}
