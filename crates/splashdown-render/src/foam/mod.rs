//! Foam, spray and bubbles.
//!
//! # How it works
//! Every diffuse particle is a white billboard, blended over the picture. All have nearly the same
//! colour, so their order hardly matters and no sorting is necessary. Depth is tested and not
//! written. If the frame has a liquid, bubbles are drawn before it, into the texture that the
//! liquid refracts, so that the liquid also refracts, tints and hides them. Foam and spray are
//! drawn after the liquid, into a layer of their own, which one triangle draws over the picture. Both
//! have one sample per pixel: the outlines are soft, and a software driver blends every sample. The
//! layer and its depths take 12 bytes per pixel, and 8 if the picture has one sample per pixel. Traced
//! pictures have one sample per pixel and draw foam and spray directly.
//!
//! Measured with lavapipe on two cores: the last 20 frames of `dam-break` take 8.1 s to draw again, with
//! reading and encoding; with four samples per pixel, and squares instead of triangles, they took 11.1 s
//! (docs/performance.md, The demo).
//!
//! A particle of spray stands for a cloud of drops, and one of foam for a patch of bubbles: the
//! billboard shows a group of four, whose places and sizes are pseudo-random functions of the id, and a
//! veil of smaller ones. Single discs look like gravel, and the same group everywhere like flakes of
//! snow. Few groups and members are large. Foam lies in the surface: its billboard is foreshortened
//! like a horizontal disc, and a depth offset moves it slightly towards the eye, because the surface
//! would cut it in two. Members and groups smaller than a pixel are enlarged to one pixel and their
//! opacity is reduced accordingly, so that distant spray adds up to a veil.
//!
//! *Motion.* Every member is blurred to a strip with round ends along the way of the particle while the
//! shutter is open, with an opacity that is lower by the ratio of the areas. The triangle surrounds
//! the strip of the whole group.
//!
//! # Why not the other way
//! Four samples per pixel show no difference in the foam itself. Where a body or the liquid hides
//! foam, the outline is not smoothed: the depth is that of the first sample.
//!
//! Bubbles drawn into the picture too are visible where no liquid is in front of them, which is when the
//! eye is inside the liquid. The cost is that of bubbles with four samples.
//!
//! Ray marching through a volume of foam density (used offline by Ihmsen et al. 2012) includes
//! self-shadowing, but takes as long as all other passes together. Additive discs would exceed
//! white.
//!
//! # Things we might try
//! Shadows of foam on the floor; reflections of spray in the water.

mod layer;

use crate::chunks::{Chunk, bind_chunks};
use crate::error::{check_radius, check_shutter};
use crate::globals::Globals;
use crate::pipeline::{Bind, DIMMING, Depth, PREMULTIPLIED, PipelineDesc, bind_group_layout};
use crate::shader::{ENVIRONMENT, GLOBALS, Shader};
use crate::targets::LAYER_FORMAT;
use crate::{FoamBuffers, RenderError};
pub(crate) use layer::FoamLayer;
#[cfg(test)]
pub(crate) use layer::{DEPTHS, OVER};
use wgpu::{BindGroupLayout, Device, RenderPass, RenderPipeline, TextureFormat};

pub(crate) const SHADER: Shader =
    Shader { label: "foam", parts: &[GLOBALS, ENVIRONMENT, include_str!("foam.wgsl")] };

/// Foam, spray and bubbles drawn as billboards.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct DrawnFoam<'a> {
    /// The diffuse particles.
    pub buffers: FoamBuffers<'a>,
    /// Half the particle spacing of the fluid in metres. The size of the billboards is proportional to it.
    pub radius: f32,
    /// Time in seconds for which the shutter is open: the particles are blurred along the way that they move in it. If the
    /// samples of a traced picture have a [shutter](crate::Quality::shutter), it replaces this one.
    pub shutter: f32,
}

/// The kinds of diffuse particles that a pass draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kinds {
    /// Bubbles, before the liquid.
    UnderWater,
    /// Foam and spray, after the liquid.
    OverWater,
    /// All kinds, in a frame without liquid.
    All,
}

#[derive(Debug)]
pub(crate) struct Foam {
    pipelines: [RenderPipeline; 3],
    layout: BindGroupLayout,
}

impl<'a> DrawnFoam<'a> {
    /// Diffuse particles in a fluid of a particle radius in metres, half the particle spacing. Without motion blur.
    pub fn new(buffers: FoamBuffers<'a>, radius: f32) -> DrawnFoam<'a> {
        DrawnFoam { buffers, radius, shutter: 0.0 }
    }

    /// The same with a shutter that is open for this time in seconds.
    #[must_use]
    pub fn with_shutter(self, shutter: f32) -> DrawnFoam<'a> {
        DrawnFoam { shutter, ..self }
    }

    /// Checks the values and writes the uniforms.
    pub(crate) fn fill(&self, globals: &mut Globals) -> Result<(), RenderError> {
        self.buffers.check()?;
        check_radius(self.radius)?;
        check_shutter("the shutter of the foam", self.shutter)?;
        globals.foam_radius = self.radius;
        globals.foam_shutter = self.shutter;
        Ok(())
    }
}

impl Foam {
    pub fn new(
        device: &Device,
        [globals, environment]: [&BindGroupLayout; 2],
        format: TextureFormat,
    ) -> Foam {
        let layout = bind_group_layout(device, "foam", &[Bind::Storage]);
        let layouts = [globals, environment, &layout];
        // In the order of `Kinds`: a mask with a bit per kind, the target, and the blending.
        let pipelines =
            [(4.0, format, DIMMING), (3.0, LAYER_FORMAT, PREMULTIPLIED), (7.0, LAYER_FORMAT, PREMULTIPLIED)];
        let pipelines = pipelines.map(|(kinds, format, blend)| {
            let constants = [("KINDS", kinds)];
            let desc = PipelineDesc {
                depth: Some(Depth::Test),
                blend: Some(blend),
                constants: &constants,
                ..PipelineDesc::new(SHADER, &layouts, format)
            };
            desc.build(device)
        });
        Foam { pipelines, layout }
    }

    /// Binds the particles as group 2.
    pub fn bind(&self, device: &Device, drawn: &DrawnFoam<'_>) -> Vec<Chunk> {
        bind_chunks(device, "foam", &self.layout, drawn.buffers.count, &[drawn.buffers.column()], &[])
    }

    /// Draws some kinds with one sample per pixel: [`Kinds::UnderWater`] into a texture of the format of the picture, whose
    /// alpha becomes the fraction of the light from behind that passes, and the others into one of [`LAYER_FORMAT`]. Expects
    /// groups 0 (globals) and 1 (environment) to be bound.
    pub fn record(&self, pass: &mut RenderPass<'_>, chunks: &[Chunk], kinds: Kinds) {
        if chunks.is_empty() {
            return;
        }
        pass.set_pipeline(&self.pipelines[kinds as usize]);
        for chunk in chunks {
            chunk.draw(pass, 2, 3);
        }
    }
}
