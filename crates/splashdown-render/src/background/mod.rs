//! Sky and floor.
//!
//! # How it works
//! One triangle covers the picture. Each pixel asks `environment.wgsl` what its ray sees: the floor, a plane a little
//! below the box with tiles of a round size (1, 2 or 5 times a power of ten metres) that fade into the horizon, or the
//! sky. The same functions answer the mirrored rays of the water, so reflections and background always agree. The
//! checkerboard is averaged over the pixel's footprint in closed form (after I. Quilez, "Filtering procedural
//! textures", 2013) and needs no mip maps.
//!
//! # Why not the other way
//! An environment map would need a file, memory and a lookup that knows nothing of the floor's nearness; reflections of
//! the tiles would slide as the camera moves.
//!
//! # Things we might try
//! A physical sky; caustics on the floor.

use crate::pipeline::{Depth, Recipe};
use crate::shader::{ENVIRONMENT, GLOBALS, Shader};
use wgpu::{BindGroupLayout, Device, RenderPass, RenderPipeline, TextureFormat};

pub(crate) const SHADER: Shader =
    Shader { label: "background", parts: &[GLOBALS, ENVIRONMENT, include_str!("background.wgsl")] };

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
        let recipe = Recipe { samples, depth: Some(Depth::Write), ..Recipe::new(SHADER, &layouts, format) };
        Background { pipeline: recipe.build(device) }
    }

    /// Groups 0 (globals) and 1 (environment) are set.
    pub fn record(&self, pass: &mut RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.draw(0..3, 0..1);
    }
}
