//! The light that reaches floor and bodies through the liquid.

use crate::pipeline::{ADD, Bind, PipelineDesc, bind_group, bind_group_layout};
use crate::recorder::Recorder;
use crate::shadow::{Blur, FloorLight, SKY, SUNLIGHT};
use crate::targets::texture;
use wgpu::{
    BindGroup, BindGroupLayout, BindingResource, Color, Device, PrimitiveTopology, RenderPipeline,
    TextureFormat, TextureUsages, TextureView,
};

/// Texels on a side of the map of the sunlight. As many rays of the sun are followed.
const SIDE: u32 = 512;
/// The maps of the sunlight on bodies: tiles of [`SIDE`] texels for each layer, as in `sun_layers.wgsl`.
const BODIES_SIDE: u32 = 4 * SIDE;
/// Texels on a side of the map of the sky.
const SKY_SIDE: u32 = 128;
/// Standard deviations of the blurs in texels: caustics remain sharp; a texel of the sky has few
/// rays.
const SUNLIGHT_BLUR: f64 = 1.0;
const SKY_BLUR: f64 = 2.0;

#[derive(Debug)]
pub(super) struct Floor {
    photons: RenderPipeline,
    splat: RenderPipeline,
    splat_on_bodies: RenderPipeline,
    sky: RenderPipeline,
    arrivals: TextureView,
    arrivals_group: BindGroup,
    sunlight_maps: [TextureView; 2],
    bodies_map: TextureView,
    sky_maps: [TextureView; 2],
    sunlight_blur: Blur,
    sky_blur: Blur,
    /// Group 1 of the shaders that use the environment.
    pub environment: BindGroup,
}

impl Floor {
    pub fn new(
        device: &Device,
        globals: &BindGroupLayout,
        trees: &BindGroupLayout,
        floor_light: &FloorLight,
    ) -> Floor {
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
        let map = |label, side, format| texture(device, label, [side; 2], format, 1, usage);
        let arrivals = map("arrivals", SIDE, TextureFormat::Rgba32Float);
        let sunlight_maps = ["sunlight", "sunlight between blurs"].map(|label| map(label, SIDE, SUNLIGHT));
        let sky_maps = ["sky", "sky between blurs"].map(|label| map(label, SKY_SIDE, SKY));
        let none = bind_group_layout(device, "nothing", &[]);
        let traced = [globals, &none, trees];
        let side = [("SIDE", f64::from(SIDE))];
        let photons = PipelineDesc {
            constants: &side,
            ..PipelineDesc::new(super::PHOTONS, &traced, TextureFormat::Rgba32Float)
        };
        let sky_side = [("SIDE", f64::from(SKY_SIDE))];
        let sky = PipelineDesc { constants: &sky_side, ..PipelineDesc::new(super::FLOOR_SKY, &traced, SKY) };
        let arrivals_layout = bind_group_layout(device, "arrivals", &[Bind::VertexTexture]);
        let splat_layouts = [globals, &arrivals_layout];
        let splat = |bodies: f64| {
            let desc = PipelineDesc {
                topology: PrimitiveTopology::PointList,
                blend: Some(ADD),
                constants: &[("BODIES", bodies)],
                ..PipelineDesc::new(super::SPLAT, &splat_layouts, SUNLIGHT)
            };
            desc.build(device)
        };
        let bodies_map = map("sunlight on bodies", BODIES_SIDE, SUNLIGHT);
        let resources = [BindingResource::TextureView(&arrivals)];
        let [sunlight, sunlight_between] = &sunlight_maps;
        let [sky_map, sky_between] = &sky_maps;
        Floor {
            photons: photons.build(device),
            splat: splat(0.0),
            splat_on_bodies: splat(1.0),
            sky: sky.build(device),
            arrivals_group: bind_group(device, "arrivals", &arrivals_layout, &resources),
            environment: floor_light.bind(device, [sunlight, sky_map, &bodies_map]),
            sunlight_blur: Blur::new(device, [sunlight, sunlight_between], SUNLIGHT, SUNLIGHT_BLUR),
            sky_blur: Blur::new(device, [sky_map, sky_between], SKY, SKY_BLUR),
            arrivals,
            sunlight_maps,
            bodies_map,
            sky_maps,
        }
    }

    /// Computes the sunlight; a sample with another index follows other rays.
    pub fn record_sunlight(
        &self,
        recorder: &mut Recorder<'_>,
        globals: &BindGroup,
        trees: &BindGroup,
        has_bodies: bool,
    ) {
        {
            let mut pass = recorder.cleared("rays of the sun", &self.arrivals, Color::TRANSPARENT);
            pass.set_pipeline(&self.photons);
            pass.set_bind_group(0, globals, &[]);
            pass.set_bind_group(2, trees, &[]);
            pass.draw(0..3, 0..1);
        }
        let mut collect = |label, map, pipeline| {
            let mut pass = recorder.cleared(label, map, Color::TRANSPARENT);
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, globals, &[]);
            pass.set_bind_group(1, &self.arrivals_group, &[]);
            pass.draw(0..SIDE * SIDE, 0..1);
        };
        collect("sunlight on the floor", &self.sunlight_maps[0], &self.splat);
        if has_bodies {
            collect("sunlight on bodies", &self.bodies_map, &self.splat_on_bodies);
        }
        self.sunlight_blur.record(recorder, [&self.sunlight_maps[0], &self.sunlight_maps[1]]);
    }

    /// Computes the visible fraction of the sky, which is 1 everywhere without bodies.
    pub fn record_sky(
        &self,
        recorder: &mut Recorder<'_>,
        globals: &BindGroup,
        trees: &BindGroup,
        has_bodies: bool,
    ) {
        {
            let mut pass = recorder.cleared("sky above the floor", &self.sky_maps[0], Color::WHITE);
            if !has_bodies {
                return;
            }
            pass.set_pipeline(&self.sky);
            pass.set_bind_group(0, globals, &[]);
            pass.set_bind_group(2, trees, &[]);
            pass.draw(0..3, 0..1);
        }
        self.sky_blur.record(recorder, [&self.sky_maps[0], &self.sky_maps[1]]);
    }
}
