//! Foam, spray and bubbles.
//!
//! # How it works
//! Every diffuse particle is a soft white disc that faces the eye, laid over the picture. All are nearly
//! equally white, so that their order hardly matters and nothing is sorted. Depth is tested and not written.
//! Where there is liquid, bubbles are drawn before it, into the picture that it is looked through: so they are
//! bent, tinted and hidden as all else under water. Foam and spray come after it.
//!
//! Foam lies in the surface, which would cut each disc in two; its depth is a little nearer than its place.
//! Discs that would be smaller than a pixel are drawn as large as one and as much fainter.
//!
//! # Why not the other way
//! A volume of foam's density that rays are marched through (Ihmsen et al. 2012 draw so, off line) has
//! self-shadowing, for the cost of all else in the picture together. Additive discs would be brighter than any
//! white.
//!
//! # Things we might try
//! Shadows of foam on the floor; a mirror image of spray in the water.

use crate::frame::check_radius;
use crate::globals::Globals;
use crate::particles::{chunks_of, part};
use crate::pipeline::{Bind, Depth, OVER, Recipe, bind_group, bind_group_layout};
use crate::shader::{ENVIRONMENT, GLOBALS, SPHERE, Shader};
use crate::{FoamBuffers, RenderError};
use wgpu::{BindGroup, BindGroupLayout, Device, RenderPass, RenderPipeline, TextureFormat};

pub(crate) const SHADER: Shader =
    Shader { label: "foam", parts: &[GLOBALS, ENVIRONMENT, SPHERE, include_str!("foam.wgsl")] };

/// Bytes of a diffuse particle.
const STRIDE: u64 = 32;

/// Foam, spray and bubbles, and how to draw them.
#[derive(Clone, Copy, Debug)]
pub struct DrawnFoam<'a> {
    /// Where they are.
    pub buffers: FoamBuffers<'a>,
    /// Half the spacing of the fluid's particles in metres; what is drawn is smaller.
    pub radius: f32,
}

/// What is drawn of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    /// Bubbles, before the liquid.
    UnderWater,
    /// Foam and spray, after it.
    OverWater,
    /// All, where there is no liquid.
    All,
}

#[derive(Debug)]
pub(crate) struct Foam {
    pipelines: [RenderPipeline; 3],
    layout: BindGroupLayout,
}

impl DrawnFoam<'_> {
    pub(crate) fn fill(&self, globals: &mut Globals) -> Result<(), RenderError> {
        self.buffers.check()?;
        check_radius(self.radius)?;
        globals.foam_radius = self.radius;
        Ok(())
    }
}

impl Foam {
    pub fn new(
        device: &Device,
        [globals, environment]: [&BindGroupLayout; 2],
        format: TextureFormat,
        samples: u32,
    ) -> Foam {
        let layout = bind_group_layout(device, "foam", &[Bind::Storage]);
        let layouts = [globals, environment, &layout];
        let pipelines = [4.0, 3.0, 7.0].map(|kinds| {
            let constants = [("KINDS", kinds)];
            let recipe = Recipe {
                samples,
                depth: Some(Depth::Test),
                blend: Some(OVER),
                constants: &constants,
                ..Recipe::new(SHADER, &layouts, format)
            };
            recipe.build(device)
        });
        Foam { pipelines, layout }
    }

    /// Binds the particles, in as many pieces as the device's largest binding asks for.
    pub fn bind(&self, device: &Device, drawn: &DrawnFoam<'_>) -> Vec<(BindGroup, u32)> {
        let FoamBuffers { particles, count } = drawn.buffers;
        chunks_of(device, count, STRIDE)
            .map(|(start, count)| {
                let resources = [part(particles, STRIDE, start, count)];
                (bind_group(device, "foam", &self.layout, &resources), count)
            })
            .collect()
    }

    /// Groups 0 (globals) and 1 (environment) are set.
    pub fn record(&self, pass: &mut RenderPass<'_>, chunks: &[(BindGroup, u32)], part: Part) {
        if chunks.is_empty() {
            return;
        }
        pass.set_pipeline(&self.pipelines[part as usize]);
        for (group, count) in chunks {
            pass.set_bind_group(2, group, &[]);
            pass.draw(0..6 * count, 0..1);
        }
    }
}
