//! The tank of a liquid: panes of glass at the closed sides of the box.
//!
//! # How it works
//! Each of the four upright walls that is closed is a slab outside the box. Only faces towards the
//! eye are drawn. The large faces reflect the environment (Fresnel equations, both faces of the
//! pane); the narrow ones show the light that the pane guides from its opposite end, green and dark
//! from absorption on the way. A large face mirrors the floor below the height of the eye and the sky
//! above it; each part has its own pipeline. The corner of two panes behind the liquid, into whose
//! narrow faces one looks, is tinted. Panes behind the liquid are drawn before it, the others after
//! it. There is no lid: a pane that reflects the sky
//! would hide the liquid in most views. The floor of the tank is that of the scene.
//!
//! # Why not the other way
//! Refraction in a plane pane only shifts a ray by a fraction of its thickness, which is not
//! visible.

use crate::Domain;
use crate::pipeline::{Depth, PREMULTIPLIED, PipelineDesc};
use crate::shader::{ENVIRONMENT, GLOBALS, OPTICS, Shader};
use wgpu::{BindGroupLayout, Device, RenderPass, RenderPipeline, TextureFormat};

pub(crate) const SHADER: Shader =
    Shader { label: "glass", parts: &[GLOBALS, ENVIRONMENT, OPTICS, include_str!("glass.wgsl")] };

#[derive(Debug)]
pub(crate) struct Glass {
    /// In front of the liquid, and behind it: each for the parts `MIRRORS_FLOOR`, `MIRRORS_SKY` and `NARROW` of `glass.wgsl`.
    pipelines: [[RenderPipeline; 3]; 2],
}

/// The panes that a pass draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Panes {
    InFront,
    Behind,
}

impl Glass {
    pub fn new(
        device: &Device,
        layouts: [&BindGroupLayout; 2],
        format: TextureFormat,
        samples: u32,
    ) -> Glass {
        let pipeline = |behind, part| {
            let constants = [("BEHIND", behind), ("PART", part)];
            let desc = PipelineDesc {
                samples,
                depth: Some(Depth::Test),
                blend: Some(PREMULTIPLIED),
                constants: &constants,
                ..PipelineDesc::new(SHADER, &layouts, format)
            };
            desc.build(device)
        };
        let pipelines = [0.0, 1.0].map(|behind| [0.0, 1.0, 2.0].map(|part| pipeline(behind, part)));
        Glass { pipelines }
    }

    /// Draws some of the panes. Expects groups 0 (globals) and 1 (environment) to be bound.
    pub fn record(&self, pass: &mut RenderPass<'_>, panes: Panes) {
        for pipeline in &self.pipelines[panes as usize] {
            pass.set_pipeline(pipeline);
            // Four panes with six faces of six vertices.
            pass.draw(0..36, 0..4);
        }
    }
}

/// The walls that are panes, as in the uniforms: bit 0 for the lower and bit 1 for the upper wall of
/// each axis.
pub(crate) fn panes_of(domain: &Domain) -> [u32; 4] {
    let bits = |axis: usize| u32::from(domain.closed[2 * axis]) | u32::from(domain.closed[2 * axis + 1]) << 1;
    [bits(0), 0, bits(2), 0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_upright_walls_are_panes() {
        let mut domain = Domain::closed([0.0; 3], [1.0; 3]);
        domain.closed = [true, false, true, true, false, true];
        assert_eq!(panes_of(&domain), [0b01, 0, 0b10, 0]);
    }
}
