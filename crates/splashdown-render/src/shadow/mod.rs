//! The shadow of the fluid on the floor.
//!
//! # How it works
//! A small texture covers the part of the floor on which the box can cast a shadow. Every vertex or
//! particle is projected along the rays of the sun onto the floor, and blending sums the path
//! length in fluid above each texel: a closed mesh adds the heights of its upper faces and
//! subtracts those of its lower ones, a particle adds its volume divided by the area of the texel.
//! Two one-dimensional Gaussian blurs soften the edge. The floor is then darkened by absorption
//! (Beer-Lambert), so a clear liquid casts a bright and tinted shadow, and spheres a dark one.
//!
//! # Why not the other way
//! A shadow map with depths distinguishes only lit and unlit, which is wrong for water, and needs a
//! bias. The map used here does not model shadows on the fluid itself, which a depth map would.
//!
//! # Things we might try
//! Caustics: refract the ray of each vertex at the surface and divide by the area it illuminates.

use crate::chunks::bind_chunks;
use crate::globals::SHADOW_SIDE;
use crate::pipeline::{ADD, Bind, PipelineDesc, bind_group, bind_group_layout, linear_sampler};
use crate::recorder::Recorder;
use crate::shader::{FULLSCREEN, GLOBALS, Shader};
use crate::targets::texture;
use crate::{DrawnLiquidParticles, DrawnParticles, DrawnSurface, Frame};
use wgpu::{
    BindGroup, BindGroupLayout, BindingResource, Color, Device, PrimitiveTopology, RenderPipeline,
    TextureFormat, TextureUsages, TextureView,
};

const FORMAT: TextureFormat = TextureFormat::R16Float;

pub(crate) const FROM_SURFACE: Shader =
    Shader { label: "surface shadow", parts: &[GLOBALS, include_str!("surface_shadow.wgsl")] };
pub(crate) const FROM_PARTICLES: Shader =
    Shader { label: "particle shadow", parts: &[GLOBALS, include_str!("particle_shadow.wgsl")] };
pub(crate) const BLUR: Shader =
    Shader { label: "shadow blur", parts: &[FULLSCREEN, include_str!("blur.wgsl")] };

#[derive(Debug)]
pub(crate) struct Shadow {
    from_surface: RenderPipeline,
    from_bodies: RenderPipeline,
    from_particles: RenderPipeline,
    particles_layout: BindGroupLayout,
    blurs: [RenderPipeline; 2],
    blur_sources: [BindGroup; 2],
    /// The sum, and the intermediate result between the two blurs.
    maps: [TextureView; 2],
    /// Layout and bind group of group 1, for every shader that uses the environment.
    pub environment_layout: BindGroupLayout,
    pub environment: BindGroup,
}

impl Shadow {
    pub fn new(device: &Device, globals: &BindGroupLayout) -> Shadow {
        let maps = ["shadow", "shadow between blurs"].map(|label| {
            let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
            texture(device, label, [SHADOW_SIDE; 2], FORMAT, 1, usage)
        });
        let blur_layout = bind_group_layout(device, "shadow blur", &[Bind::Texture]);
        let blur_sources = [0, 1].map(|source: usize| {
            bind_group(device, "shadow blur", &blur_layout, &[BindingResource::TextureView(&maps[source])])
        });
        let blurs = [(1.0, 0.0), (0.0, 1.0)].map(|(x, y)| {
            let constants = [("STEP_X", x), ("STEP_Y", y)];
            PipelineDesc { constants: &constants, ..PipelineDesc::new(BLUR, &[&blur_layout], FORMAT) }
                .build(device)
        });
        let surface_layouts = [globals];
        let from_surface = PipelineDesc {
            blend: Some(ADD),
            vertex_buffers: 1,
            ..PipelineDesc::new(FROM_SURFACE, &surface_layouts, FORMAT)
        };
        // A body absorbs like a hundred times as much water, which makes it opaque.
        let solid = [("WEIGHT", 100.0)];
        let from_bodies = PipelineDesc { constants: &solid, ..from_surface };
        let particles_layout = bind_group_layout(device, "particle shadow", &[Bind::Storage]);
        let particle_layouts = [globals, &particles_layout];
        let from_particles = PipelineDesc {
            blend: Some(ADD),
            topology: PrimitiveTopology::PointList,
            ..PipelineDesc::new(FROM_PARTICLES, &particle_layouts, FORMAT)
        };
        let environment_layout = bind_group_layout(device, "environment", &[Bind::Texture, Bind::Sampler]);
        let sampler = linear_sampler(device);
        let resources = [BindingResource::TextureView(&maps[0]), BindingResource::Sampler(&sampler)];
        Shadow {
            from_surface: from_surface.build(device),
            from_bodies: from_bodies.build(device),
            from_particles: from_particles.build(device),
            environment: bind_group(device, "environment", &environment_layout, &resources),
            environment_layout,
            particles_layout,
            blurs,
            blur_sources,
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
            let mut pass = recorder.cleared("shadow", &self.maps[0], Color::TRANSPARENT);
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
            } else if frame.bodies.is_none() {
                return;
            }
            if let Some(buffers) = &frame.bodies {
                pass.set_pipeline(&self.from_bodies);
                buffers.draw(&mut pass);
            }
        }
        for (blur, source) in self.blurs.iter().zip([0, 1]) {
            let mut pass = recorder.cleared("shadow blur", &self.maps[1 - source], Color::TRANSPARENT);
            pass.set_pipeline(blur);
            pass.set_bind_group(0, &self.blur_sources[source], &[]);
            pass.draw(0..3, 0..1);
        }
    }
}
