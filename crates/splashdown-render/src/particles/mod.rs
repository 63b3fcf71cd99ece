//! Particles as spheres.
//!
//! # How it works
//! Every particle is a triangle: three vertices that load their particle from the storage buffers. The
//! triangle faces the eye, in the plane through the centre of the sphere. With the centre at distance
//! d, the cone tangent to the sphere of radius r intersects this plane in a circle of radius R, R^2
//! = d^2 r^2 / (d^2 - r^2). The vertex shader outputs q, the position in the plane in units of R.
//! The ray D to that position intersects the sphere at s D with |s D - c| = r. Because D = c + R q
//! with c and q perpendicular, the discriminant d^4 - |D|^2 (d^2 - r^2) equals d^2 r^2 (1 - |q|^2),
//! so
//!
//! ```text
//! s = d (d - r sqrt(1 - |q|^2)) / |D|^2
//! ```
//!
//! without the cancellation that makes small distant spheres flicker. The outline is |q| = 1. The
//! fragment shader tests it at each sample of the pixel and outputs a sample mask, so the spheres
//! need no sorting. The depth is that of the intersection.
//!
//! The vertex shader computes the quantity that colours the particle and looks it up in a texture
//! of 256 colours, which the colour bar also uses.
//!
//! Measured with lavapipe (Mesa 22.3.6) on two cores at 1280 x 720 with four samples, background
//! and shadow: 66,560 spheres in 0.23 s.
//!
//! # Why not the other way
//! * Squares instead of triangles around the outline: 0.8 times the pixels, twice the vertices and triangles. They took
//!   0.25 s in the same case, and the smaller billboards of foam 1.3 times as long.
//! * Instances: software drivers treat each instance as a separate draw, and three vertices do
//!   not fill a vector register.
//! * Alpha to coverage: lavapipe (Mesa 22.3) writes the depth of samples that are not covered, so
//!   that the floor shows through every outline; the mask also cannot select individual samples.
//! * Per-sample shading: smooth seams between spheres too, for four times the work.
//! * Icospheres: a hundred times the vertices, for a smoother interior that is invisible at this
//!   size.
//!
//! # Things we might try
//! Ambient occlusion from the cells of the neighbour search.

use crate::chunks::{Chunk, bind_chunks};
use crate::colour_map::ColourTextures;
use crate::error::check_radius;
use crate::globals::Globals;
use crate::pipeline::{Bind, Depth, PipelineDesc, bind_group_layout};
use crate::shader::{GLOBALS, QUANTITY, SPHERE, Shader};
use crate::{Colouring, ParticleBuffers, RenderError};
use wgpu::{BindGroupLayout, BindingResource, Device, RenderPass, RenderPipeline, TextureFormat};

pub(crate) const SHADER: Shader =
    Shader { label: "particles", parts: &[GLOBALS, SPHERE, QUANTITY, include_str!("particles.wgsl")] };

/// Particles drawn as spheres.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct DrawnParticles<'a> {
    /// The particles.
    pub buffers: ParticleBuffers<'a>,
    /// Radius of the spheres in metres, usually half the particle spacing.
    pub radius: f32,
    /// Their colours.
    pub colouring: Colouring,
}

impl<'a> DrawnParticles<'a> {
    /// Spheres of a radius in metres, usually half the particle spacing.
    pub fn new(buffers: ParticleBuffers<'a>, radius: f32, colouring: Colouring) -> DrawnParticles<'a> {
        DrawnParticles { buffers, radius, colouring }
    }

    /// Checks the values and writes the uniforms.
    pub(crate) fn fill(&self, globals: &mut Globals) -> Result<(), RenderError> {
        self.buffers.check()?;
        check_radius(self.radius)?;
        let [low, high] = self.colouring.checked_range()?;
        globals.particle_radius = self.radius;
        globals.quantity = self.colouring.quantity.index();
        globals.range_low = low;
        globals.range_scale = 1.0 / (high - low);
        // Spheres are opaque; a few layers of them cast a dark shadow.
        globals.shadow_absorption = [0.35 / self.radius; 3];
        globals.set_shadow_of_particles(self.radius);
        Ok(())
    }
}

#[derive(Debug)]
pub(crate) struct Particles {
    pipeline: RenderPipeline,
    layout: BindGroupLayout,
    colours: ColourTextures,
}

impl Particles {
    pub fn new(
        device: &Device,
        [globals, environment]: [&BindGroupLayout; 2],
        format: TextureFormat,
        samples: u32,
        colours: ColourTextures,
    ) -> Particles {
        let bindings = [Bind::Storage, Bind::Storage, Bind::Storage, Bind::VertexTexture];
        let layout = bind_group_layout(device, "particles", &bindings);
        let layouts = [globals, environment, &layout];
        let constants = [("SAMPLES", f64::from(samples))];
        let desc = PipelineDesc {
            samples,
            depth: Some(Depth::TestAndWrite),
            constants: &constants,
            ..PipelineDesc::new(SHADER, &layouts, format)
        };
        Particles { pipeline: desc.build(device), colours, layout }
    }

    /// Binds the particles as group 2.
    pub fn bind(&self, device: &Device, drawn: &DrawnParticles<'_>) -> Vec<Chunk> {
        let colours = BindingResource::TextureView(self.colours.of(drawn.colouring.map));
        let columns = drawn.buffers.columns();
        bind_chunks(device, "particles", &self.layout, drawn.buffers.count, &columns, &[colours])
    }

    /// Draws the spheres. Expects groups 0 (globals) and 1 (environment) to be bound.
    pub fn record(&self, pass: &mut RenderPass<'_>, chunks: &[Chunk]) {
        pass.set_pipeline(&self.pipeline);
        for chunk in chunks {
            chunk.draw(pass, 2, 3);
        }
    }
}
