//! A separable Gaussian blur of a map of the floor.

use crate::pipeline::{Bind, PipelineDesc, bind_group, bind_group_layout};
use crate::recorder::Recorder;
use crate::shader::{FULLSCREEN, Shader};
use wgpu::{BindGroup, BindingResource, Color, Device, RenderPipeline, TextureFormat, TextureView};

pub(crate) const SHADER: Shader =
    Shader { label: "shadow blur", parts: &[FULLSCREEN, include_str!("blur.wgsl")] };

/// Blurs the first of two maps; the second holds the intermediate result.
#[derive(Debug)]
pub(crate) struct Blur {
    pipelines: [RenderPipeline; 2],
    sources: [BindGroup; 2],
}

impl Blur {
    /// `sigma`: standard deviation in texels.
    pub fn new(device: &Device, maps: [&TextureView; 2], format: TextureFormat, sigma: f64) -> Blur {
        let layout = bind_group_layout(device, "shadow blur", &[Bind::Texels]);
        let sources =
            maps.map(|map| bind_group(device, "shadow blur", &layout, &[BindingResource::TextureView(map)]));
        let pipelines = [(1.0, 0.0), (0.0, 1.0)].map(|(x, y)| {
            let constants = [("STEP_X", x), ("STEP_Y", y), ("SIGMA", sigma)];
            PipelineDesc { constants: &constants, ..PipelineDesc::new(SHADER, &[&layout], format) }
                .build(device)
        });
        Blur { pipelines, sources }
    }

    pub fn record(&self, recorder: &mut Recorder<'_>, maps: [&TextureView; 2]) {
        for (i, pipeline) in self.pipelines.iter().enumerate() {
            let mut pass = recorder.cleared("shadow blur", maps[1 - i], Color::TRANSPARENT);
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &self.sources[i], &[]);
            pass.draw(0..3, 0..1);
        }
    }
}
