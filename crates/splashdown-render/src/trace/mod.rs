//! Pictures of liquids with traced rays.
//!
//! # How it works
//! Fragment shaders follow rays through the trees of liquid and bodies (module `tree`).
//!
//! 1. *Sunlight on floor and bodies*: every texel of a map of the floor follows one ray of the sun through
//!    the panes and the liquid, with refraction, absorption and total internal reflection, and stores
//!    where it arrives. Points with additive blending then collect the light where it arrives, which makes
//!    caustics and the shadows of bodies. Light that arrives at bodies is collected in layers by height
//!    (`sun_layers.wgsl`). A map of the visible fraction of the sky darkens the floor
//!    around bodies.
//! 2. *Samples*: background, bodies, liquid, droplets, foam and glass are drawn with one sample per pixel as
//!    light without tone mapping. The depth of the liquid is drawn first, so that its shader runs
//!    once per pixel. It follows the refracted ray from surface to surface (Fresnel equations, total
//!    internal reflection, absorption by Beer-Lambert) until it meets a body, the floor or the sky,
//!    and the reflected ray if it matters. Bodies and floor are darker in the liquid than outside. Every sample shifts the place in the pixel, on the lens
//!    and in time; the samples are averaged. The samples of a picture in which liquid and bodies move are drawn from several
//!    frames, each with its own trees.
//!    With the eye inside the bounds of the liquid, every ray is also followed from the eye, for the pixels
//!    that lie in the liquid (`inside.wgsl`).
//! 3. *Tone mapping* of the average.
//!
//! # Why not the other way
//! Ray-tracing extensions are not part of WebGPU. Four hardware samples per pixel, shaded
//! once as in pictures without traced rays, would leave refraction and highlights aliased. A path tracer that chooses every direction at
//! random needs hundreds of samples; here nothing is random below 17 samples per pixel, so that
//! pictures with few samples have no noise. `cargo xtask cycles` compares both.
//!
//! # Things we might try
//! Bubbles under water; droplets in reflections.

mod floor;
mod picture;

use crate::shader::{
    ENVIRONMENT, FULLSCREEN, GLOBALS, MATTE, OPTICS, REFRACTED, SUN_LAYERS, SUNLIT, Shader, TRACE,
};

pub(crate) use picture::TracedPicture;

pub(crate) const DEPTH: Shader =
    Shader { label: "depth of the liquid", parts: &[GLOBALS, include_str!("depth.wgsl")] };
pub(crate) const LIQUID: Shader = Shader {
    label: "traced liquid",
    parts: &[
        GLOBALS,
        ENVIRONMENT,
        OPTICS,
        TRACE,
        SUN_LAYERS,
        SUNLIT,
        MATTE,
        REFRACTED,
        include_str!("liquid.wgsl"),
    ],
};
pub(crate) const INSIDE: Shader = Shader {
    label: "inside the liquid",
    parts: &[
        GLOBALS,
        FULLSCREEN,
        ENVIRONMENT,
        OPTICS,
        TRACE,
        SUN_LAYERS,
        SUNLIT,
        MATTE,
        REFRACTED,
        include_str!("inside.wgsl"),
    ],
};
pub(crate) const PHOTONS: Shader = Shader {
    label: "rays of the sun",
    parts: &[GLOBALS, FULLSCREEN, OPTICS, TRACE, SUN_LAYERS, include_str!("photons.wgsl")],
};
pub(crate) const SPLAT: Shader =
    Shader { label: "sunlight on the floor", parts: &[GLOBALS, SUN_LAYERS, include_str!("splat.wgsl")] };
pub(crate) const FLOOR_SKY: Shader = Shader {
    label: "sky above the floor",
    parts: &[GLOBALS, FULLSCREEN, TRACE, include_str!("floor_sky.wgsl")],
};
pub(crate) const ACCUMULATE: Shader =
    Shader { label: "mean of samples", parts: &[GLOBALS, FULLSCREEN, include_str!("accumulate.wgsl")] };
pub(crate) const RESOLVE: Shader =
    Shader { label: "tone mapping", parts: &[GLOBALS, FULLSCREEN, include_str!("resolve.wgsl")] };
