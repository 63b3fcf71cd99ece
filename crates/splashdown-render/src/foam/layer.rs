//! The layer of foam: a picture of its own with one sample per pixel, which is then drawn over the picture.

use crate::pipeline::{Bind, Depth, PREMULTIPLIED, PipelineDesc, bind_group, bind_group_layout};
use crate::recorder::Recorder;
use crate::shader::{FULLSCREEN, Shader};
use crate::targets::{FoamTargets, Targets};
use wgpu::{
    BindGroupLayout, BindingResource, Device, RenderPass, RenderPipeline, TextureFormat, TextureView,
};

pub(crate) const DEPTHS: Shader =
    Shader { label: "depths of foam", parts: &[FULLSCREEN, include_str!("depths.wgsl")] };
pub(crate) const OVER: Shader =
    Shader { label: "foam over picture", parts: &[FULLSCREEN, include_str!("over.wgsl")] };

/// The passes before and after the foam.
#[derive(Debug)]
pub(crate) struct FoamLayer {
    depths: RenderPipeline,
    depths_layout: BindGroupLayout,
    over: RenderPipeline,
    over_layout: BindGroupLayout,
}

impl FoamLayer {
    pub fn new(device: &Device, format: TextureFormat, samples: u32) -> FoamLayer {
        let depths_layout = bind_group_layout(device, "depths", &[Bind::Depths { multisampled: true }]);
        let over_layout = bind_group_layout(device, "foam", &[Bind::Texels]);
        let layouts = [&depths_layout];
        let depths = PipelineDesc { depth: Some(Depth::Write), ..PipelineDesc::new(DEPTHS, &layouts, None) };
        let layouts = [&over_layout];
        let over = PipelineDesc {
            samples,
            // The pass has depths, which the pipeline has to declare.
            depth: Some(Depth::Ignore),
            blend: Some(PREMULTIPLIED),
            ..PipelineDesc::new(OVER, &layouts, format)
        };
        FoamLayer { depths: depths.build(device), over: over.build(device), depths_layout, over_layout }
    }

    /// The depths of the picture with one sample per pixel; copies them if it has several.
    pub fn depths<'a>(
        &self,
        device: &Device,
        recorder: &mut Recorder<'_>,
        targets: &'a Targets,
        foam: &'a FoamTargets,
    ) -> &'a TextureView {
        let Some(depths) = &foam.depths else { return &targets.depth };
        let samples = [BindingResource::TextureView(&targets.depth)];
        let mut pass = recorder.depths("depths of foam", depths);
        pass.set_pipeline(&self.depths);
        pass.set_bind_group(0, &bind_group(device, "depths", &self.depths_layout, &samples), &[]);
        pass.draw(0..3, 0..1);
        depths
    }

    /// Draws the layer over the picture. Replaces bind group 0.
    pub fn record(&self, device: &Device, pass: &mut RenderPass<'_>, foam: &FoamTargets) {
        let layer = [BindingResource::TextureView(&foam.colours)];
        pass.set_pipeline(&self.over);
        pass.set_bind_group(0, &bind_group(device, "foam", &self.over_layout, &layer), &[]);
        pass.draw(0..3, 0..1);
    }
}
