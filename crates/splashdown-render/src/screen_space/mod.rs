//! The liquid straight from its particles, without a mesh.
//!
//! # How it works
//! *Splat*: every particle is a sphere a little larger than its share of space, so that neighbours merge; the
//! nearest one in each pixel leaves its distance. *Smooth*: the narrow-range filter (Truong and Yuksel 2018)
//! turns the heap of spheres into a surface. It averages with a Gaussian whose width in pixels follows the
//! distance, along one axis and then the other, twice over, and at last in a small square against the streaks
//! that this leaves. Samples in front of a narrow range around the middle are left out together with their
//! mirror image, so that near liquid has no halo in the far; samples behind it count as lying just behind the
//! middle, which rounds the rim; and the range grows with every sample inside it, so that slopes stay.
//! *Amount*: every particle adds its volume over a soft disc, in half resolution. *Compose*: normals from the
//! distances' differences, the smaller one at edges; then the light of `shared/liquid.wgsl`, which the mesh has
//! too.
//!
//! Distances are drawn with a margin around the picture: smoothing that knows nothing of what lies beyond the
//! border would bend the surface there.
//!
//! The outline of a heap of spheres is bumpy, and no filter of distances mends it. So the first round of
//! smoothing also averages the share of pixels that have liquid, and the outline is drawn where that falls
//! below a bound: bumps are cut off, and the same number says how much of a pixel is inside. Depth is that of
//! the smoothed surface, so solids and the box's lines cut it as they do the mesh.
//!
//! 16-bit floats hold the amount to a thousandth; where more than a thousand particles lie behind each other,
//! the sum stops growing, long after the liquid has become opaque.
//!
//! Software Vulkan (lavapipe, Mesa 22.3.6) on two cores, 63,000 particles, 1280 x 720, four samples, all in one
//! run of `examples/ways.rs`: 1.4 times as long as the same particles as spheres, 1.2 times a mesh of 298,000
//! triangles; a quarter each for amount, splats and smoothing. With one sample, where spheres need half the
//! time, 2.7 and 2.4 times.
//!
//! # Why not the other way
//! Curvature flow (van der Laan et al. 2009) needs some fifty passes for the same smoothness. A bilateral filter keeps
//! the spheres of thin layers and rounds steps into each other. Ellipsoids from the neighbours' covariance are smoother
//! still and cost a visit of the neighbours. Depths with four samples would mean four pictures to smooth.
//!
//! # Things we might try
//! Smoothing in half resolution for very large pictures; outlines of liquid in front of liquid, which stay bumpy.

use crate::frame::check_radius;
use crate::globals::Globals;
use crate::particles::{chunks, part};
use crate::pipeline::{ADD, Bind, DEPTH, Depth, OVER, Recipe, bind_group, bind_group_layout, linear_sampler};
use crate::recorder::Recorder;
use crate::shader::{ENVIRONMENT, GLOBALS, LIQUID, SPHERE, Shader};
use crate::targets::{THICKNESS_FORMAT, Targets, texture};
use crate::{Liquid, ParticleBuffers, RenderError};
use wgpu::{
    BindGroup, BindGroupLayout, BindingResource, Color, Device, RenderPass, RenderPipeline, Sampler,
    TextureFormat, TextureUsages, TextureView,
};

const NARROW_RANGE: &str = include_str!("narrow_range.wgsl");
pub(crate) const SPLAT: Shader =
    Shader { label: "splat", parts: &[GLOBALS, SPHERE, include_str!("splat.wgsl")] };
pub(crate) const AMOUNT: Shader =
    Shader { label: "amount", parts: &[GLOBALS, SPHERE, include_str!("amount.wgsl")] };
pub(crate) const SMOOTH: Shader =
    Shader { label: "smooth", parts: &[GLOBALS, NARROW_RANGE, include_str!("smooth.wgsl")] };
pub(crate) const CLEAN: Shader =
    Shader { label: "clean", parts: &[GLOBALS, NARROW_RANGE, include_str!("clean.wgsl")] };
pub(crate) const COMPOSE: Shader =
    Shader { label: "compose", parts: &[GLOBALS, ENVIRONMENT, LIQUID, include_str!("compose.wgsl")] };

/// Distances need all their bits: a normal is a difference of neighbours.
const DISTANCE_FORMAT: TextureFormat = TextureFormat::Rg32Float;
/// Distance where there is no liquid; `NOTHING` in the shaders.
const NOTHING: Color = Color { r: 1e30, ..Color::TRANSPARENT };
/// Reach of the two rounds of smoothing, in radii of the splats. The second one removes what the first leaves where its
/// samples stand apart.
const REACH: [f64; 2] = [1.9, 0.9];
/// Radius of the splats, in particle radii. Spheres on a lattice close the gaps between four of them from 1.42
/// on; larger ones have a smoother outline, of which compose.wgsl cuts off what is too much.
const SPLAT_REACH: f32 = 1.7;
/// Radius of the discs that the amount is spread over, in particle radii.
const AMOUNT_REACH: f32 = 3.0;

/// Particles to be drawn as liquid.
#[derive(Clone, Copy, Debug)]
pub struct DrawnLiquidParticles<'a> {
    /// Where they are; velocities and densities are not read.
    pub buffers: ParticleBuffers<'a>,
    /// Half the particle spacing in metres. The spheres that are merged are a little larger.
    pub radius: f32,
    /// How the liquid looks.
    pub liquid: Liquid,
}

/// As many pixels as the filter looks at on each side, where its samples do not stand apart.
const MARGIN: u32 = 24;

#[derive(Debug)]
pub(crate) struct ScreenSpace {
    splat: RenderPipeline,
    amount: RenderPipeline,
    smooth: [RenderPipeline; 4],
    clean: RenderPipeline,
    compose: RenderPipeline,
    particles_layout: BindGroupLayout,
    solid_layout: BindGroupLayout,
    distances_layout: BindGroupLayout,
    compose_layout: BindGroupLayout,
    sampler: Sampler,
    maps: Option<Maps>,
}

/// Textures of the picture's size and a margin.
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
        let compose_bindings = [Bind::Texture, Bind::Texture, Bind::Sampler, Bind::Texels];
        let compose_layout = bind_group_layout(device, "compose", &compose_bindings);
        let splat_layouts = [globals, &particles_layout];
        let splat = Recipe {
            depth: Some(Depth::TestAndWrite),
            ..Recipe::new(SPLAT, &splat_layouts, DISTANCE_FORMAT)
        };
        let amount_layouts = [globals, &solid_layout, &particles_layout];
        let amount = Recipe { blend: Some(ADD), ..Recipe::new(AMOUNT, &amount_layouts, THICKNESS_FORMAT) };
        let filter_layouts = [globals, &distances_layout];
        let smooth = [(1.0, 0.0, 0), (0.0, 1.0, 0), (1.0, 0.0, 1), (0.0, 1.0, 1)].map(|(x, y, round)| {
            let share = if round == 0 { 1.0 } else { 0.0 };
            let constants = [("STEP_X", x), ("STEP_Y", y), ("REACH", REACH[round]), ("SHARE", share)];
            let recipe = Recipe::new(SMOOTH, &filter_layouts, DISTANCE_FORMAT);
            Recipe { constants: &constants, ..recipe }.build(device)
        });
        let compose_layouts = [globals, environment, &compose_layout];
        let compose = Recipe {
            samples,
            depth: Some(Depth::TestAndWrite),
            blend: Some(OVER),
            ..Recipe::new(COMPOSE, &compose_layouts, format)
        };
        ScreenSpace {
            splat: splat.build(device),
            amount: amount.build(device),
            smooth,
            clean: Recipe::new(CLEAN, &filter_layouts, DISTANCE_FORMAT).build(device),
            compose: compose.build(device),
            sampler: linear_sampler(device),
            particles_layout,
            solid_layout,
            distances_layout,
            compose_layout,
            maps: None,
        }
    }

    /// Binds the particles, in as many pieces as the device's largest binding asks for.
    pub fn bind(&self, device: &Device, buffers: &ParticleBuffers<'_>) -> Vec<(BindGroup, u32)> {
        chunks(device, buffers.count)
            .map(|(start, count)| {
                let positions = [part(buffers.positions, 16, start, count)];
                (bind_group(device, "liquid particles", &self.particles_layout, &positions), count)
            })
            .collect()
    }

    /// Sums up the liquid on every view ray. Group 0 (globals) is set.
    pub fn record_amount(
        &self,
        device: &Device,
        pass: &mut RenderPass<'_>,
        targets: &Targets,
        chunks: &[(BindGroup, u32)],
    ) {
        let solid = [BindingResource::TextureView(&targets.solid)];
        let solid = bind_group(device, "solid", &self.solid_layout, &solid);
        pass.set_pipeline(&self.amount);
        pass.set_bind_group(1, &solid, &[]);
        for (group, count) in chunks {
            pass.set_bind_group(2, group, &[]);
            pass.draw(0..6 * count, 0..1);
        }
    }

    /// Splats the particles and smooths their distances; the group that composing needs.
    pub fn record_distances(
        &mut self,
        device: &Device,
        recorder: &mut Recorder<'_>,
        targets: &Targets,
        globals: &BindGroup,
        chunks: &[(BindGroup, u32)],
    ) -> BindGroup {
        let size = targets.size.map(|side| side + 2 * margin(device, targets.size));
        let kept = self.maps.take().filter(|maps| maps.size == size);
        let maps = kept.unwrap_or_else(|| Maps::new(device, size));
        // Made anew each time: the thickness belongs to the picture's other textures.
        let sources = maps.distances.each_ref().map(|view| {
            let views = [view, &targets.thickness].map(BindingResource::TextureView);
            bind_group(device, "distances", &self.distances_layout, &views)
        });
        {
            let mut pass = recorder.cleared_with_depth("splat", &maps.distances[0], NOTHING, &maps.depth);
            pass.set_pipeline(&self.splat);
            pass.set_bind_group(0, globals, &[]);
            for (group, count) in chunks {
                pass.set_bind_group(1, group, &[]);
                pass.draw(0..6 * count, 0..1);
            }
        }
        let filters = self.smooth.iter().map(|filter| ("smooth", filter)).chain([("clean", &self.clean)]);
        for (index, (label, filter)) in filters.enumerate() {
            let source = index % 2;
            let mut pass = recorder.cleared(label, &maps.distances[1 - source], NOTHING);
            pass.set_pipeline(filter);
            pass.set_bind_group(0, globals, &[]);
            pass.set_bind_group(1, &sources[source], &[]);
            pass.draw(0..3, 0..1);
        }
        let resources = [
            BindingResource::TextureView(&targets.scene),
            BindingResource::TextureView(&targets.thickness),
            BindingResource::Sampler(&self.sampler),
            BindingResource::TextureView(&maps.distances[1]),
        ];
        let group = bind_group(device, "compose", &self.compose_layout, &resources);
        self.maps = Some(maps);
        group
    }

    /// Lays the liquid over the picture. Groups 0 (globals) and 1 (environment) are set.
    pub fn record(&self, pass: &mut RenderPass<'_>, group: &BindGroup) {
        pass.set_pipeline(&self.compose);
        pass.set_bind_group(2, group, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// Pixels by which the distances' picture is wider on each side than the picture.
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

impl DrawnLiquidParticles<'_> {
    /// Checks the numbers and hands them to the shaders.
    pub(crate) fn fill(&self, globals: &mut Globals) -> Result<(), RenderError> {
        self.buffers.check()?;
        check_radius(self.radius)?;
        self.liquid.fill(globals)?;
        globals.splat_radius = SPLAT_REACH * self.radius;
        globals.amount_radius = AMOUNT_REACH * self.radius;
        // The weights of a disc have a mean of a third.
        let area = std::f32::consts::PI * globals.amount_radius.powi(2) / 3.0;
        globals.amount = (2.0 * self.radius).powi(3) / area;
        globals.set_shadow_of_particles(self.radius);
        Ok(())
    }
}
