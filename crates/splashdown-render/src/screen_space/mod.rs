//! The surface of the liquid in screen space, directly from the particles, without a mesh.
//!
//! # How it works
//! 1. *Splat*: every particle is a sphere slightly larger than its volume, so that neighbours
//!    overlap. The distance of the nearest sphere in each pixel is stored.
//! 2. *Smooth*: the narrow-range filter (Truong and Yuksel 2018) turns the spheres into a surface.
//!    It averages with a Gaussian whose width in pixels follows the distance, along one axis and
//!    then the other, twice, and finally in a small square, which removes the streaks of the
//!    separable passes. Samples in front of a narrow range around the centre are skipped together
//!    with their mirror image, so that near liquid leaves no halo on far liquid. Samples behind the
//!    range are clamped to slightly behind the centre, which rounds the rim. The range grows with
//!    every sample inside it, so that slopes are preserved.
//! 3. *Thickness*: every particle adds its volume over a soft disc, at half resolution.
//! 4. *Compose*: normals from the differences of the distances, weighted towards the smaller one at
//!    edges; then the shading of `shared/liquid.wgsl`, which the mesh uses too.
//!
//! The distance texture is larger than the picture by a margin: smoothing without data beyond the
//! border would bend the surface there.
//!
//! The outline of a set of spheres is bumpy, and no filter of distances can change it. So the first
//! round of smoothing also averages the fraction of pixels that contain liquid, and the outline is
//! the level set of this fraction at a threshold: this removes the bumps and gives the coverage of
//! a pixel. The depth is that of the smoothed surface, so bodies and the lines of the box intersect
//! it as they do the mesh.
//!
//! 16-bit floats store the thickness with a relative precision of 1e-3. Where more than a thousand
//! particles lie behind each other the sum stops growing, but the liquid is already opaque at a much
//! smaller thickness.
//!
//! Measured with lavapipe (Mesa 22.3.6) on two cores at 1280 x 720 with four samples and 63,000
//! particles, in one run of `examples/modes.rs`: 1.4 times the time of the same particles as
//! spheres; thickness, splats and smoothing take a quarter each. With one sample, where spheres take
//! half the time, the ratio is 2.7.
//!
//! # Why not the other way
//! Curvature flow (van der Laan et al. 2009) needs about fifty passes for the same smoothness. A
//! bilateral filter leaves the spheres of thin layers visible and blends steps into each other.
//! Ellipsoids from the covariance of the neighbours are smoother but need a neighbour loop.
//! Distances with four samples would mean smoothing four pictures.
//!
//! # Things we might try
//! Smoothing at half resolution for very large pictures; smoother outlines of liquid in front of
//! liquid.

use crate::chunks::{Chunk, bind_chunks};
use crate::error::check_radius;
use crate::globals::Globals;
use crate::pipeline::{
    ADD, Bind, DEPTH, Depth, OVER, PipelineDesc, bind_group, bind_group_layout, linear_sampler,
};
use crate::recorder::Recorder;
use crate::shader::{ENVIRONMENT, FULLSCREEN, GLOBALS, LIQUID, OPTICS, PICTURE_BEHIND, SPHERE, Shader};
use crate::targets::{THICKNESS_FORMAT, Targets, texture};
use crate::{Liquid, ParticleBuffers, RenderError};
use wgpu::{
    BindGroup, BindGroupLayout, BindingResource, Color, Device, RenderPass, RenderPipeline, Sampler,
    TextureFormat, TextureUsages, TextureView,
};

const NARROW_RANGE: &str = include_str!("narrow_range.wgsl");
pub(crate) const SPLAT: Shader =
    Shader { label: "splat", parts: &[GLOBALS, SPHERE, include_str!("splat.wgsl")] };
pub(crate) const PARTICLE_THICKNESS: Shader = Shader {
    label: "particle thickness",
    parts: &[GLOBALS, SPHERE, include_str!("particle_thickness.wgsl")],
};
pub(crate) const SMOOTH: Shader =
    Shader { label: "smooth", parts: &[GLOBALS, FULLSCREEN, NARROW_RANGE, include_str!("smooth.wgsl")] };
pub(crate) const CLEANUP: Shader =
    Shader { label: "cleanup", parts: &[GLOBALS, FULLSCREEN, NARROW_RANGE, include_str!("cleanup.wgsl")] };
pub(crate) const COMPOSE: Shader = Shader {
    label: "compose",
    parts: &[GLOBALS, FULLSCREEN, ENVIRONMENT, OPTICS, PICTURE_BEHIND, LIQUID, include_str!("compose.wgsl")],
};

/// Distances need full precision: a normal is a difference of neighbouring distances.
const DISTANCE_FORMAT: TextureFormat = TextureFormat::Rg32Float;
/// Distance of pixels without liquid; equals `NO_LIQUID` in the shaders.
const NO_LIQUID: Color = Color { r: 1e30, ..Color::TRANSPARENT };
/// Filter radius of the two rounds of smoothing, in radii of the splats. The second round removes
/// artefacts of the first where its samples are more than a pixel apart.
const REACH: [f64; 2] = [1.9, 0.9];
/// Radius of the splats, in particle radii. From 1.42 on, spheres on a lattice leave no gaps.
/// Larger spheres have a smoother outline; compose.wgsl removes the excess.
const SPLAT_REACH: f32 = 1.7;
/// Radius of the discs over which the volume is distributed, in particle radii.
const THICKNESS_REACH: f32 = 3.0;

/// Particles drawn as a liquid in screen space.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct DrawnLiquidParticles<'a> {
    /// The particles; velocities and densities are not read.
    pub buffers: ParticleBuffers<'a>,
    /// Half the particle spacing in metres. The splatted spheres are slightly larger.
    pub radius: f32,
    /// Optical properties of the liquid.
    pub liquid: Liquid,
}

/// Margin of the distance texture in pixels: the largest number of taps of the filter on each side.
pub(crate) const MARGIN: u32 = 24;

#[derive(Debug)]
pub(crate) struct ScreenSpace {
    splat: RenderPipeline,
    thickness: RenderPipeline,
    smooth: [RenderPipeline; 4],
    cleanup: RenderPipeline,
    compose: RenderPipeline,
    particles_layout: BindGroupLayout,
    solid_layout: BindGroupLayout,
    distances_layout: BindGroupLayout,
    compose_layout: BindGroupLayout,
    sampler: Sampler,
    maps: Option<Maps>,
}

/// Textures of the size of the picture plus a margin.
#[derive(Debug)]
struct Maps {
    size: [u32; 2],
    depth: TextureView,
    distances: [TextureView; 2],
}

impl ScreenSpace {
    pub fn new(
        device: &Device,
        [globals, environment]: [&BindGroupLayout; 2],
        format: TextureFormat,
        samples: u32,
    ) -> ScreenSpace {
        let particles_layout = bind_group_layout(device, "liquid particles", &[Bind::Storage]);
        let solid_layout = bind_group_layout(device, "solid", &[Bind::Texture]);
        let distances_layout = bind_group_layout(device, "distances", &[Bind::Texels, Bind::Texels]);
        let compose_bindings =
            [Bind::TextureLayers, Bind::Texture, Bind::Sampler, Bind::TextureLayers, Bind::Texels];
        let compose_layout = bind_group_layout(device, "compose", &compose_bindings);
        let splat_layouts = [globals, &particles_layout];
        let splat = PipelineDesc {
            depth: Some(Depth::TestAndWrite),
            ..PipelineDesc::new(SPLAT, &splat_layouts, DISTANCE_FORMAT)
        };
        let thickness_layouts = [globals, &solid_layout, &particles_layout];
        let thickness = PipelineDesc {
            blend: Some(ADD),
            ..PipelineDesc::new(PARTICLE_THICKNESS, &thickness_layouts, THICKNESS_FORMAT)
        };
        let filter_layouts = [globals, &distances_layout];
        let smooth = [(1.0, 0.0, 0), (0.0, 1.0, 0), (1.0, 0.0, 1), (0.0, 1.0, 1)].map(|(x, y, round)| {
            let average = if round == 0 { 1.0 } else { 0.0 };
            let constants =
                [("STEP_X", x), ("STEP_Y", y), ("REACH", REACH[round]), ("AVERAGE_FRACTION", average)];
            let desc = PipelineDesc::new(SMOOTH, &filter_layouts, DISTANCE_FORMAT);
            PipelineDesc { constants: &constants, ..desc }.build(device)
        });
        let compose_layouts = [globals, environment, &compose_layout];
        let compose = PipelineDesc {
            samples,
            depth: Some(Depth::TestAndWrite),
            blend: Some(OVER),
            ..PipelineDesc::new(COMPOSE, &compose_layouts, format)
        };
        ScreenSpace {
            splat: splat.build(device),
            thickness: thickness.build(device),
            smooth,
            cleanup: PipelineDesc::new(CLEANUP, &filter_layouts, DISTANCE_FORMAT).build(device),
            compose: compose.build(device),
            sampler: linear_sampler(device),
            particles_layout,
            solid_layout,
            distances_layout,
            compose_layout,
            maps: None,
        }
    }

    /// Binds the positions of the particles.
    pub fn bind(&self, device: &Device, buffers: &ParticleBuffers<'_>) -> Vec<Chunk> {
        let positions = [buffers.position_column()];
        bind_chunks(device, "liquid particles", &self.particles_layout, buffers.count, &positions, &[])
    }

    /// Sums the thickness of the liquid on every view ray. Expects group 0 (globals) to be bound.
    pub fn record_thickness(
        &self,
        device: &Device,
        pass: &mut RenderPass<'_>,
        targets: &Targets,
        chunks: &[Chunk],
    ) {
        let solid = [BindingResource::TextureView(&targets.solid)];
        let solid = bind_group(device, "solid", &self.solid_layout, &solid);
        pass.set_pipeline(&self.thickness);
        pass.set_bind_group(1, &solid, &[]);
        for chunk in chunks {
            chunk.draw(pass, 2, 3);
        }
    }

    /// Splats the particles and smooths their distances; returns the bind group for
    /// [`ScreenSpace::record`].
    pub fn record_distances(
        &mut self,
        device: &Device,
        recorder: &mut Recorder<'_>,
        targets: &Targets,
        globals: &BindGroup,
        chunks: &[Chunk],
    ) -> BindGroup {
        let size = targets.size.map(|side| side + 2 * margin(device, targets.size));
        let kept = self.maps.take().filter(|maps| maps.size == size);
        let maps = kept.unwrap_or_else(|| Maps::new(device, size));
        // Not cached, because the thickness texture is owned by `targets`.
        let sources = maps.distances.each_ref().map(|view| {
            let views = [view, &targets.thickness].map(BindingResource::TextureView);
            bind_group(device, "distances", &self.distances_layout, &views)
        });
        {
            let mut pass = recorder.cleared_with_depth("splat", &maps.distances[0], NO_LIQUID, &maps.depth);
            pass.set_pipeline(&self.splat);
            pass.set_bind_group(0, globals, &[]);
            for chunk in chunks {
                chunk.draw(&mut pass, 1, 3);
            }
        }
        let filters = self.smooth.iter().map(|filter| ("smooth", filter)).chain([("cleanup", &self.cleanup)]);
        for (index, (label, filter)) in filters.enumerate() {
            let source = index % 2;
            let mut pass = recorder.cleared(label, &maps.distances[1 - source], NO_LIQUID);
            pass.set_pipeline(filter);
            pass.set_bind_group(0, globals, &[]);
            pass.set_bind_group(1, &sources[source], &[]);
            pass.draw(0..3, 0..1);
        }
        let resources = [
            BindingResource::TextureView(&targets.scenes.view),
            BindingResource::TextureView(&targets.thickness),
            BindingResource::Sampler(&self.sampler),
            BindingResource::TextureView(&targets.solids.view),
            BindingResource::TextureView(&maps.distances[1]),
        ];
        let group = bind_group(device, "compose", &self.compose_layout, &resources);
        self.maps = Some(maps);
        group
    }

    /// Blends the liquid over the picture. Expects groups 0 (globals) and 1 (environment) to be
    /// bound.
    pub fn record(&self, pass: &mut RenderPass<'_>, group: &BindGroup) {
        pass.set_pipeline(&self.compose);
        pass.set_bind_group(2, group, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// Margin of the distance texture on each side, in pixels, within the limit of the device.
pub(crate) fn margin(device: &Device, [width, height]: [u32; 2]) -> u32 {
    let limit = device.limits().max_texture_dimension_2d;
    MARGIN.min((limit - limit.min(width.max(height))) / 2)
}

impl Maps {
    fn new(device: &Device, size: [u32; 2]) -> Maps {
        let drawn = TextureUsages::RENDER_ATTACHMENT;
        let distances = ["distances", "smoothed distances"].map(|label| {
            texture(device, label, size, DISTANCE_FORMAT, 1, drawn | TextureUsages::TEXTURE_BINDING)
        });
        Maps { size, depth: texture(device, "depth of splats", size, DEPTH, 1, drawn), distances }
    }
}

impl<'a> DrawnLiquidParticles<'a> {
    /// A liquid of particles of a radius in metres, half the particle spacing.
    pub fn new(buffers: ParticleBuffers<'a>, radius: f32, liquid: Liquid) -> DrawnLiquidParticles<'a> {
        DrawnLiquidParticles { buffers, radius, liquid }
    }

    /// Pixels around a tile that the filters read beyond the margin, for liquid at this distance in metres or farther:
    /// both rounds of smoothing follow one another, and the cleanup and the normals read neighbours.
    pub(crate) fn border(&self, distance: f32, pixel_angle: f32) -> u32 {
        let splat = SPLAT_REACH * self.radius;
        // Nearer liquid than a tenth of a splat fills the picture.
        let pixels = splat / ((distance - splat).max(0.1 * splat) * pixel_angle);
        let reach = (REACH[0] + REACH[1]) as f32 * pixels;
        (reach.ceil() as u32 + 4).saturating_sub(MARGIN).max(4)
    }

    /// Checks the values and writes the uniforms.
    pub(crate) fn fill(&self, globals: &mut Globals) -> Result<(), RenderError> {
        self.buffers.check()?;
        check_radius(self.radius)?;
        self.liquid.fill(globals)?;
        globals.splat_radius = SPLAT_REACH * self.radius;
        globals.thickness_radius = THICKNESS_REACH * self.radius;
        // The mean weight of a disc is one third.
        let area = std::f32::consts::PI * globals.thickness_radius.powi(2) / 3.0;
        globals.particle_thickness = (2.0 * self.radius).powi(3) / area;
        globals.set_shadow_of_particles(self.radius);
        Ok(())
    }
}
