//! The shadow of the fluid on the floor.
//!
//! # How it works
//! A small texture covers the part of the floor on which the box can cast a shadow. Every vertex or
//! particle is projected along the rays of the sun onto the floor, and blending sums the path
//! length in fluid above each texel: a closed mesh adds the heights of its upper faces and
//! subtracts those of its lower ones, a particle adds its volume divided by the area of the texel.
//! A second channel counts the faces of bodies, which are opaque. The path becomes a fraction of sunlight by absorption (Beer-Lambert), so a clear liquid casts a
//! bright and tinted shadow, and spheres a dark one. Two one-dimensional Gaussian blurs soften the
//! edge.
//!
//! # Why not the other way
//! A shadow map with depths distinguishes only lit and unlit, which is wrong for water, and needs a
//! bias. The map used here does not model shadows on the fluid itself, which a depth map would.
//! Caustics need rays that are refracted: see the module `trace`.

mod blur;
mod floor_light;

use crate::chunks::bind_chunks;
use crate::globals::SHADOW_SIDE;
use crate::pipeline::{ADD, Bind, PipelineDesc, bind_group, bind_group_layout};
use crate::recorder::Recorder;
use crate::shader::{FULLSCREEN, GLOBALS, Shader};
use crate::targets::texture;
use crate::texture::upload_texture;
use crate::{DrawnLiquidParticles, DrawnParticles, DrawnSurface, Frame};
use wgpu::{
    BindGroup, BindGroupLayout, BindingResource, Color, ColorWrites, Device, PrimitiveTopology, Queue,
    RenderPipeline, TextureFormat, TextureUsages, TextureView,
};

pub(crate) use blur::Blur;
pub(crate) use floor_light::{FloorLight, SKY, SUNLIGHT};

/// The path in fluid in m, and the number of faces of bodies.
const FORMAT: TextureFormat = TextureFormat::Rg16Float;

pub(crate) const FROM_SURFACE: Shader =
    Shader { label: "surface shadow", parts: &[GLOBALS, include_str!("surface_shadow.wgsl")] };
pub(crate) const FROM_PARTICLES: Shader =
    Shader { label: "particle shadow", parts: &[GLOBALS, include_str!("particle_shadow.wgsl")] };
pub(crate) const ABSORB: Shader =
    Shader { label: "shadow absorption", parts: &[GLOBALS, FULLSCREEN, include_str!("absorb.wgsl")] };
#[cfg(test)]
pub(crate) const BLUR: Shader = blur::SHADER;

#[derive(Debug)]
pub(crate) struct Shadow {
    from_surface: RenderPipeline,
    from_bodies: RenderPipeline,
    from_particles: RenderPipeline,
    particles_layout: BindGroupLayout,
    absorb: RenderPipeline,
    absorb_source: BindGroup,
    blur: Blur,
    /// The path in fluid and the faces of bodies.
    path: TextureView,
    /// The fraction of sunlight, and the intermediate result between the two blurs.
    maps: [TextureView; 2],
    pub floor_light: FloorLight,
    pub environment: BindGroup,
}

impl Shadow {
    pub fn new(device: &Device, queue: &Queue, globals: &BindGroupLayout) -> Shadow {
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
        let map = |label, side, format| texture(device, label, [side; 2], format, 1, usage);
        let path = map("path to the sun", SHADOW_SIDE, FORMAT);
        let maps = ["sunlight", "sunlight between blurs"].map(|label| map(label, SHADOW_SIDE, SUNLIGHT));
        // One texel: the whole sky is visible.
        let open_sky = upload_texture(device, queue, "open sky", [1, 1], &[255; 4]);
        let path_layout = bind_group_layout(device, "path to the sun", &[Bind::Texels]);
        let resources = [BindingResource::TextureView(&path)];
        let absorb_source = bind_group(device, "path to the sun", &path_layout, &resources);
        let absorb = PipelineDesc::new(ABSORB, &[globals, &path_layout], SUNLIGHT).build(device);
        let blur = Blur::new(device, [&maps[0], &maps[1]], SUNLIGHT, 2.6);
        let surface_layouts = [globals];
        let from_surface = PipelineDesc {
            blend: Some(ADD),
            vertex_buffers: 1,
            write: ColorWrites::RED,
            ..PipelineDesc::new(FROM_SURFACE, &surface_layouts, FORMAT)
        };
        let from_bodies = PipelineDesc { write: ColorWrites::GREEN, ..from_surface };
        let particles_layout = bind_group_layout(device, "particle shadow", &[Bind::Storage]);
        let particle_layouts = [globals, &particles_layout];
        let from_particles = PipelineDesc {
            blend: Some(ADD),
            topology: PrimitiveTopology::PointList,
            ..PipelineDesc::new(FROM_PARTICLES, &particle_layouts, FORMAT)
        };
        let floor_light = FloorLight::new(device);
        Shadow {
            from_surface: from_surface.build(device),
            from_bodies: from_bodies.build(device),
            from_particles: from_particles.build(device),
            environment: floor_light.bind(device, [&maps[0], &open_sky, &open_sky]),
            floor_light,
            particles_layout,
            absorb,
            absorb_source,
            blur,
            path,
            maps,
        }
    }

    /// Draws the map. If there is a surface, particles are skipped: they lie within the shadow of
    /// the surface.
    pub fn record(
        &self,
        device: &Device,
        recorder: &mut Recorder<'_>,
        globals: &BindGroup,
        frame: &Frame<'_>,
    ) {
        let particles = match (&frame.liquid_particles, &frame.particles) {
            (Some(DrawnLiquidParticles { buffers, .. }), _) => Some(buffers),
            (None, Some(DrawnParticles { buffers, .. })) => Some(buffers),
            (None, None) => None,
        };
        {
            let mut pass = recorder.cleared("shadow", &self.path, Color::TRANSPARENT);
            pass.set_bind_group(0, globals, &[]);
            if let Some(DrawnSurface { buffers, .. }) = &frame.surface {
                pass.set_pipeline(&self.from_surface);
                buffers.draw(&mut pass);
            } else if let Some(buffers) = particles {
                pass.set_pipeline(&self.from_particles);
                let positions = [buffers.position_column()];
                let layout = &self.particles_layout;
                for chunk in bind_chunks(device, "particle shadow", layout, buffers.count, &positions, &[]) {
                    chunk.draw(&mut pass, 1, 1);
                }
            }
            if let Some(buffers) = &frame.bodies {
                pass.set_pipeline(&self.from_bodies);
                buffers.draw(&mut pass);
            }
        }
        {
            let mut pass = recorder.cleared("shadow absorption", &self.maps[0], Color::WHITE);
            pass.set_pipeline(&self.absorb);
            pass.set_bind_group(0, globals, &[]);
            pass.set_bind_group(1, &self.absorb_source, &[]);
            pass.draw(0..3, 0..1);
        }
        if particles.is_some() || frame.surface.is_some() || frame.bodies.is_some() {
            self.blur.record(recorder, [&self.maps[0], &self.maps[1]]);
        }
    }
}
