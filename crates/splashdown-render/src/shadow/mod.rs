//! The fluid's shadow on the floor.
//!
//! # How it works
//! A small texture lies on the part of the floor that the box can throw a shadow on. Every vertex or particle is moved
//! along the sun's rays to the floor, and blending sums the metres of fluid above each texel: a closed mesh adds the
//! heights of its upper faces and subtracts those of its lower ones, a particle adds its volume over the texel's area.
//! Two one-dimensional Gaussian blurs give the soft edge, and the floor loses light after Beer and Lambert, so a clear
//! liquid throws a bright and coloured shadow and spheres a dark one.
//!
//! # Why not the other way
//! A depth map from the sun knows only "lit" or "not lit", which is wrong for water, and needs a bias. This map knows
//! nothing of shadows on the fluid itself; those would be the depth map's gain.
//!
//! # Things we might try
//! Caustics: bend each vertex's ray at the surface and divide by the area it lands on.

use crate::pipeline::{ADD, Bind, Recipe, bind_group, bind_group_layout, linear_sampler};
use crate::recorder::Recorder;
use crate::shader::{GLOBALS, Shader};
use crate::{DrawnLiquidParticles, DrawnParticles, DrawnSurface, Frame, bodies, particles, surface};
use wgpu::{
    BindGroup, BindGroupLayout, BindingResource, Color, Device, PrimitiveTopology, RenderPipeline,
    TextureFormat, TextureUsages, TextureView,
};

/// Texels on a side of the map.
pub(crate) const SIDE: u32 = 256;
const FORMAT: TextureFormat = TextureFormat::R16Float;

pub(crate) const FROM_SURFACE: Shader =
    Shader { label: "surface shadow", parts: &[GLOBALS, include_str!("surface_shadow.wgsl")] };
pub(crate) const FROM_PARTICLES: Shader =
    Shader { label: "particle shadow", parts: &[GLOBALS, include_str!("particle_shadow.wgsl")] };
pub(crate) const BLUR: Shader = Shader { label: "shadow blur", parts: &[include_str!("blur.wgsl")] };

#[derive(Debug)]
pub(crate) struct Shadow {
    from_surface: RenderPipeline,
    from_bodies: RenderPipeline,
    from_particles: RenderPipeline,
    particles_layout: BindGroupLayout,
    blurs: [RenderPipeline; 2],
    blur_sources: [BindGroup; 2],
    /// The sum, and what lies between the two blurs.
    maps: [TextureView; 2],
    /// Layout and group 1 of every shader that knows the environment.
    pub environment_layout: BindGroupLayout,
    pub environment: BindGroup,
}

impl Shadow {
    pub fn new(device: &Device, globals: &BindGroupLayout) -> Shadow {
        let maps = ["shadow", "shadow between blurs"].map(|label| map(device, label));
        let blur_layout = bind_group_layout(device, "shadow blur", &[Bind::Texture]);
        let blur_sources = [0, 1].map(|source: usize| {
            bind_group(device, "shadow blur", &blur_layout, &[BindingResource::TextureView(&maps[source])])
        });
        let blurs = [(1.0, 0.0), (0.0, 1.0)].map(|(x, y)| {
            let constants = [("STEP_X", x), ("STEP_Y", y)];
            Recipe { constants: &constants, ..Recipe::new(BLUR, &[&blur_layout], FORMAT) }.build(device)
        });
        let surface_layouts = [globals];
        let from_surface = Recipe {
            blend: Some(ADD),
            vertex_buffers: 1,
            ..Recipe::new(FROM_SURFACE, &surface_layouts, FORMAT)
        };
        // A hundred metres of water let nothing through.
        let solid = [("WEIGHT", 100.0)];
        let from_bodies = Recipe { constants: &solid, ..from_surface };
        let particles_layout = bind_group_layout(device, "particle shadow", &[Bind::Storage]);
        let particle_layouts = [globals, &particles_layout];
        let from_particles = Recipe {
            blend: Some(ADD),
            topology: PrimitiveTopology::PointList,
            ..Recipe::new(FROM_PARTICLES, &particle_layouts, FORMAT)
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

    /// Fills the map; from the surface where there is one, because its shadow holds that of its particles.
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
                surface::draw(&mut pass, buffers);
            } else if let Some(buffers) = particles {
                pass.set_pipeline(&self.from_particles);
                for (start, count) in particles::chunks(device, buffers.count) {
                    let positions = particles::part(buffers.positions, 16, start, count);
                    let group = bind_group(device, "particle shadow", &self.particles_layout, &[positions]);
                    pass.set_bind_group(1, &group, &[]);
                    pass.draw(0..count, 0..1);
                }
            } else if frame.bodies.is_none() {
                return;
            }
            if let Some(buffers) = &frame.bodies {
                pass.set_pipeline(&self.from_bodies);
                bodies::draw(&mut pass, buffers);
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

fn map(device: &Device, label: &str) -> TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: SIDE, height: SIDE, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
