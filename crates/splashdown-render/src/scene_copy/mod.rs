//! A copy of the scene into a target with one sample per pixel.
//!
//! # How it works
//! The liquid refracts the scene, which is therefore drawn into its own texture. With several samples
//! per pixel the samples still contain it afterwards; with one sample the target does not. One
//! triangle copies the texture.
//!
//! # Why not the other way
//! Drawing the scene again took ten times as long, because of the procedural floor. A copy without a
//! shader needs a usage of the target that callers do not have to grant.

use crate::pipeline::{Bind, PipelineDesc, bind_group, bind_group_layout};
use crate::shader::{FULLSCREEN, Shader};
use wgpu::{
    BindGroupLayout, BindingResource, Device, RenderPass, RenderPipeline, TextureFormat, TextureView,
};

pub(crate) const SHADER: Shader =
    Shader { label: "scene copy", parts: &[FULLSCREEN, include_str!("scene_copy.wgsl")] };

#[derive(Debug)]
pub(crate) struct SceneCopy {
    pipeline: RenderPipeline,
    layout: BindGroupLayout,
}

impl SceneCopy {
    pub fn new(device: &Device, format: TextureFormat) -> SceneCopy {
        let layout = bind_group_layout(device, "scene", &[Bind::Texels]);
        let layouts = [&layout];
        SceneCopy { pipeline: PipelineDesc::new(SHADER, &layouts, format).build(device), layout }
    }

    /// Copies a scene.
    pub fn record(&self, device: &Device, pass: &mut RenderPass<'_>, scene: &TextureView) {
        let scene = [BindingResource::TextureView(scene)];
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &bind_group(device, "scene", &self.layout, &scene), &[]);
        pass.draw(0..3, 0..1);
    }
}
