//! The box as thin lines.
//!
//! # How it works
//! Each edge is a quad that the vertex shader widens on the screen to a constant number of pixels, with one
//! more pixel on each side over which it fades; so lines are smooth with and without multisampling. Edges that
//! fluid in the box can hide, those whose two walls turn their inside to the eye, are drawn before the fluid
//! and are then mirrored and bent by it like the floor; all others lie on the convex box's near side and are
//! drawn last. So every edge is drawn once.
//!
//! # Why not the other way
//! Line primitives are one pixel wide everywhere on WebGPU. Drawing all edges before and again after the fluid would
//! darken those that do not touch it.
//!
//! # Things we might try
//! Glass: a faint mirror on the front walls.

use crate::pipeline::{Depth, OVER, Recipe};
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
        let recipe = Recipe {
            samples,
            depth: Some(Depth::Test),
            blend: Some(OVER),
            topology: PrimitiveTopology::TriangleStrip,
            ..Recipe::new(SHADER, &layouts, format)
        };
        Edges { pipeline: recipe.build(device) }
    }

    /// Draws some of the twelve edges. Group 0 (globals) is set.
    pub fn record(&self, pass: &mut RenderPass<'_>, edges: Range<u32>) {
        pass.set_pipeline(&self.pipeline);
        pass.draw(0..4, edges);
    }
}
