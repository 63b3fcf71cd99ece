//! The light on the floor, bound as group 1 of every shader that uses the environment.

use crate::pipeline::{Bind, bind_group, bind_group_layout, linear_sampler};
use wgpu::{BindGroup, BindGroupLayout, BindingResource, Device, Sampler, TextureFormat, TextureView};

/// Format of the fraction of sunlight per colour.
pub(crate) const SUNLIGHT: TextureFormat = TextureFormat::Rgba16Float;
/// Format of the visible fraction of the sky.
pub(crate) const SKY: TextureFormat = TextureFormat::R16Float;

/// The layout of the group.
#[derive(Debug)]
pub(crate) struct FloorLight {
    pub layout: BindGroupLayout,
    sampler: Sampler,
}

impl FloorLight {
    pub fn new(device: &Device) -> FloorLight {
        let bindings = [Bind::Texture, Bind::Texture, Bind::Sampler, Bind::Texture];
        let layout = bind_group_layout(device, "environment", &bindings);
        FloorLight { layout, sampler: linear_sampler(device) }
    }

    /// Binds the fractions of the sunlight and of the sky on the floor, and of the sunlight on bodies, which only pictures
    /// with traced rays read.
    pub fn bind(&self, device: &Device, [sunlight, sky, bodies]: [&TextureView; 3]) -> BindGroup {
        let resources = [
            BindingResource::TextureView(sunlight),
            BindingResource::TextureView(sky),
            BindingResource::Sampler(&self.sampler),
            BindingResource::TextureView(bodies),
        ];
        bind_group(device, "environment", &self.layout, &resources)
    }
}
