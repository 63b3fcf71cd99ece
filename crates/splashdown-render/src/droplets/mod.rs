//! Droplets: spheres of liquid, blurred by their motion.
//!
//! # How it works
//! Every droplet is a quad around the disc that it sweeps while the shutter is open. In the plane through its centre,
//! with lengths in radii, the disc moves from -l to l along the first axis. It covers a place (a, b) while
//! |a - t| < sqrt(1 - b^2), so that the fraction of the time, the opacity, is the length of an interval. The shading is
//! that of the droplet at the middle of the interval: the ends fade, and the light is even between them.
//!
//! *Shape.* Droplets of one size look artificial. The volume of a moving droplet is a smooth function of its horizontal
//! velocity, which is constant in free flight, with the volume of a particle as the mean. It oscillates between a long and
//! a flat spheroid as it moves, and its normals are slightly wavy.
//!
//! *Shading.* A ray that enters a sphere leaves it at a known place: it is refracted twice there, and shows the
//! environment upside down. The reflected ray, absorption in between and the highlight of the sun are those of the
//! surface of the liquid. With traced rays both rays then hit the liquid, the bodies or the environment. Without, the
//! refracted ray of a droplet in front of a body meets the picture without the liquid at the distance of that body: it
//! showed the floor in front of a white mug. All other rays see the environment.
//!
//! *Order.* Droplets are blended over the picture in the order of the buffer, and test the depth. Foam and spray are
//! drawn later and cover all droplets: a droplet in front of spray would refract it, but rays do not find spray.
//!
//! Droplets smaller than a pixel are enlarged to one pixel and their opacity is reduced accordingly. If the samples of a
//! traced picture move in time, they move the droplets, and there are no streaks.
//!
//! # Why not the other way
//! Spheres as triangles in the mesh of the liquid are a hundred times as many vertices, have no motion blur, and look
//! like facets where they are large.
//!
//! Droplets that write their depth hide the spray behind them, and then are dark balls in white spray. The mean of
//! several times as the shading shows several images of the sun and the horizon in a row.
//!
//! # Things we might try
//! Shadows and caustics of droplets; droplets in reflections and behind other droplets.

use crate::chunks::{Chunk, bind_chunks};
use crate::error::{check_radius, check_shutter};
use crate::globals::Globals;
use crate::pipeline::{Bind, Depth, OVER, PipelineDesc, bind_group_layout, linear_sampler};
use crate::shader::{
    ENVIRONMENT, GLOBALS, MATTE, OPTICS, PICTURE_BEHIND, REFRACTED, SPHERE, SUN_LAYERS, SUNLIT, Shader, TRACE,
};
use crate::targets::Targets;
use crate::{DropletBuffers, Liquid, RenderError};
use wgpu::{BindGroupLayout, BindingResource, Device, RenderPass, RenderPipeline, Sampler, TextureFormat};

const DROPLETS: &str = include_str!("droplets.wgsl");
pub(crate) const SHADER: Shader = Shader {
    label: "droplets",
    parts: &[GLOBALS, ENVIRONMENT, OPTICS, PICTURE_BEHIND, SPHERE, include_str!("plain.wgsl"), DROPLETS],
};
pub(crate) const TRACED: Shader = Shader {
    label: "traced droplets",
    parts: &[
        GLOBALS,
        ENVIRONMENT,
        OPTICS,
        TRACE,
        SUN_LAYERS,
        SUNLIT,
        MATTE,
        REFRACTED,
        SPHERE,
        include_str!("traced.wgsl"),
        DROPLETS,
    ],
};

/// Droplets of a liquid.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct DrawnDroplets<'a> {
    /// The droplets.
    pub buffers: DropletBuffers<'a>,
    /// Their radius in metres.
    pub radius: f32,
    /// Optical properties of the liquid.
    pub liquid: Liquid,
    /// Time in seconds for which the shutter is open: droplets are blurred along the way that they move in it. If the
    /// samples of a traced picture have a [shutter](crate::Quality::shutter), it replaces this one.
    pub shutter: f32,
}

impl<'a> DrawnDroplets<'a> {
    /// Droplets of a radius in metres, without motion blur.
    pub fn new(buffers: DropletBuffers<'a>, radius: f32, liquid: Liquid) -> DrawnDroplets<'a> {
        DrawnDroplets { buffers, radius, liquid, shutter: 0.0 }
    }

    /// The same with a shutter that is open for this time in seconds.
    #[must_use]
    pub fn with_shutter(self, shutter: f32) -> DrawnDroplets<'a> {
        DrawnDroplets { shutter, ..self }
    }

    /// Checks the values and writes the uniforms.
    pub(crate) fn fill(&self, globals: &mut Globals) -> Result<(), RenderError> {
        self.buffers.check()?;
        check_radius(self.radius)?;
        check_shutter("the shutter of the droplets", self.shutter)?;
        self.liquid.fill(globals)?;
        globals.droplet_radius = self.radius;
        globals.droplet_shutter = self.shutter;
        Ok(())
    }
}

#[derive(Debug)]
pub(crate) struct Droplets {
    pipeline: RenderPipeline,
    layout: BindGroupLayout,
    /// The bind group of the droplets: behind those of the scene.
    group: u32,
    /// Reads the picture behind droplets without traced rays.
    sampler: Option<Sampler>,
}

impl Droplets {
    /// Droplets in a picture without traced rays; `scene` are the layouts of globals and environment. With traced rays it
    /// has that of the trees as well.
    pub fn new(device: &Device, scene: &[&BindGroupLayout], format: TextureFormat, samples: u32) -> Droplets {
        let is_traced = scene.len() == 3;
        let behind = [Bind::TextureLayers, Bind::TextureLayers, Bind::Sampler];
        let behind = if is_traced { &[][..] } else { &behind };
        let bindings: Vec<Bind> = [Bind::Storage].into_iter().chain(behind.iter().copied()).collect();
        let layout = bind_group_layout(device, "droplets", &bindings);
        let layouts: Vec<&BindGroupLayout> = scene.iter().copied().chain([&layout]).collect();
        let shader = if is_traced { TRACED } else { SHADER };
        let desc = PipelineDesc {
            samples,
            depth: Some(Depth::Test),
            blend: Some(OVER),
            ..PipelineDesc::new(shader, &layouts, format)
        };
        let sampler = (!is_traced).then(|| linear_sampler(device));
        Droplets { pipeline: desc.build(device), layout, group: scene.len() as u32, sampler }
    }

    /// Binds the droplets; without traced rays, with the targets that contain the picture behind them.
    pub fn bind(&self, device: &Device, drawn: &DrawnDroplets<'_>, targets: Option<&Targets>) -> Vec<Chunk> {
        let behind = |(targets, sampler)| {
            let Targets { scenes, solids, .. }: &Targets = targets;
            [&scenes.view, &solids.view]
                .map(BindingResource::TextureView)
                .into_iter()
                .chain([BindingResource::Sampler(sampler)])
        };
        let behind: Vec<_> = targets.zip(self.sampler.as_ref()).into_iter().flat_map(behind).collect();
        bind_chunks(device, "droplets", &self.layout, drawn.buffers.count, &[drawn.buffers.column()], &behind)
    }

    /// Draws the droplets. Expects the groups of the scene to be bound.
    pub fn record(&self, pass: &mut RenderPass<'_>, chunks: &[Chunk]) {
        if chunks.is_empty() {
            return;
        }
        pass.set_pipeline(&self.pipeline);
        for chunk in chunks {
            chunk.draw(pass, self.group, 6);
        }
    }
}
