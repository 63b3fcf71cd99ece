//! Droplets: spheres of liquid, blurred by their motion.
//!
//! # How it works
//! Every droplet is a quad around the disc that it sweeps while the shutter is open. In the plane through its centre,
//! with lengths in radii, the disc moves from -l to l along the first axis. It covers a place (a, b) while
//! |a - t| < sqrt(1 - b^2), so that the fraction of the time, the opacity, is the length of an interval. The shading is
//! the mean of that of the sphere at some times of the interval.
//!
//! *Shading.* A ray that enters a sphere leaves it at a known place: it is refracted twice there, and shows the
//! environment upside down. The reflected ray, absorption in between and the highlight of the sun are those of the
//! surface of the liquid. With traced rays both rays then hit the liquid, the bodies or the environment.
//!
//! *Order.* Pixels that a droplet covers all the time are drawn first and write the depth. The others, outlines and
//! streaks, are blended over the picture afterwards and only test it.
//!
//! Droplets smaller than a pixel are enlarged to one pixel and their opacity is reduced accordingly. If the samples of a
//! traced picture move in time, they move the droplets, and there are no streaks.
//!
//! # Why not the other way
//! Spheres as triangles in the mesh of the liquid are a hundred times as many vertices, have no motion blur, and look
//! like facets where they are large.
//!
//! # Things we might try
//! Shadows and caustics of droplets; droplets in reflections and behind other droplets.

use crate::chunks::{Chunk, bind_chunks};
use crate::error::check_radius;
use crate::globals::Globals;
use crate::pipeline::{Bind, Depth, OVER, PipelineDesc, bind_group_layout};
use crate::shader::{ENVIRONMENT, GLOBALS, MATTE, OPTICS, REFRACTED, SPHERE, Shader, TRACE};
use crate::{DropletBuffers, Liquid, RenderError};
use wgpu::{BindGroupLayout, Device, RenderPass, RenderPipeline, TextureFormat};

const DROPLETS: &str = include_str!("droplets.wgsl");
pub(crate) const SHADER: Shader = Shader {
    label: "droplets",
    parts: &[GLOBALS, ENVIRONMENT, OPTICS, SPHERE, include_str!("plain.wgsl"), DROPLETS],
};
pub(crate) const TRACED: Shader = Shader {
    label: "traced droplets",
    parts: &[
        GLOBALS,
        ENVIRONMENT,
        OPTICS,
        TRACE,
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
        if !(self.shutter >= 0.0 && self.shutter.is_finite()) {
            return Err(RenderError::Value {
                what: "the shutter of the droplets",
                given: format!("{} s", self.shutter),
                allowed: "a finite number of at least 0",
            });
        }
        self.liquid.fill(globals)?;
        globals.droplet_radius = self.radius;
        globals.droplet_shutter = self.shutter;
        Ok(())
    }
}

/// The pipelines of pixels that droplets cover all the time, and of the others.
#[derive(Debug)]
pub(crate) struct Droplets {
    pipelines: [RenderPipeline; 2],
    layout: BindGroupLayout,
    /// The bind group of the droplets: behind those of the scene.
    group: u32,
}

impl Droplets {
    /// Droplets in a picture without traced rays; `scene` are the layouts of globals and environment. With traced rays it
    /// has that of the trees as well.
    pub fn new(device: &Device, scene: &[&BindGroupLayout], format: TextureFormat, samples: u32) -> Droplets {
        let layout = bind_group_layout(device, "droplets", &[Bind::Storage]);
        let layouts: Vec<&BindGroupLayout> = scene.iter().copied().chain([&layout]).collect();
        let shader = if scene.len() == 3 { TRACED } else { SHADER };
        let pipelines = [true, false].map(|is_opaque| {
            let constants = [("OPAQUE", f64::from(u8::from(is_opaque)))];
            let desc = PipelineDesc {
                samples,
                depth: Some(if is_opaque { Depth::TestAndWrite } else { Depth::Test }),
                blend: (!is_opaque).then_some(OVER),
                constants: &constants,
                ..PipelineDesc::new(shader, &layouts, format)
            };
            desc.build(device)
        });
        Droplets { pipelines, layout, group: scene.len() as u32 }
    }

    /// Binds the droplets.
    pub fn bind(&self, device: &Device, drawn: &DrawnDroplets<'_>) -> Vec<Chunk> {
        bind_chunks(device, "droplets", &self.layout, drawn.buffers.count, &[drawn.buffers.column()], &[])
    }

    /// Draws the droplets. Expects the groups of the scene to be bound.
    pub fn record(&self, pass: &mut RenderPass<'_>, chunks: &[Chunk]) {
        if chunks.is_empty() {
            return;
        }
        for pipeline in &self.pipelines {
            pass.set_pipeline(pipeline);
            for chunk in chunks {
                chunk.draw(pass, self.group, 6);
            }
        }
    }
}
