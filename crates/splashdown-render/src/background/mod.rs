//! Sky and floor.
//!
//! # How it works
//! One triangle covers the picture. Each pixel evaluates `environment.wgsl` for its ray: the floor,
//! a plane slightly below the box with tiles of a round size (1, 2 or 5 times a power of ten
//! metres) that fade into the horizon, or the sky. Reflections in the water use the same functions,
//! so reflections and background agree. The checkerboard is averaged over the footprint of the
//! pixel in closed form (I. Quilez, "Filtering procedural textures", 2013) and needs no mip maps.
//!
//! # Why not the other way
//! An environment map would need a file and memory, and would not model the finite distance of the
//! floor: reflections of the tiles would slide as the camera moves.
//!
//! # Things we might try
//! A physical sky model; caustics on the floor.

use crate::pipeline::{Depth, PipelineDesc};
use crate::shader::{ENVIRONMENT, FULLSCREEN, GLOBALS, Shader};
use wgpu::{BindGroupLayout, Device, RenderPass, RenderPipeline, TextureFormat};

pub(crate) const SHADER: Shader = Shader {
    label: "background",
    parts: &[GLOBALS, FULLSCREEN, ENVIRONMENT, include_str!("background.wgsl")],
};

#[derive(Debug)]
pub(crate) struct Background {
    pipeline: RenderPipeline,
}

impl Background {
    pub fn new(
        device: &Device,
        layouts: [&BindGroupLayout; 2],
        format: TextureFormat,
        samples: u32,
    ) -> Background {
        let desc = PipelineDesc {
            samples,
            depth: Some(Depth::Write),
            ..PipelineDesc::new(SHADER, &layouts, format)
        };
        Background { pipeline: desc.build(device) }
    }

    /// Draws the background. Expects groups 0 (globals) and 1 (environment) to be bound.
    pub fn record(&self, pass: &mut RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.draw(0..3, 0..1);
    }
}
