// Fraction of the sunlight that reaches each point of the floor, from the path in fluid and the bodies above it. Needs
// globals.wgsl, fullscreen.wgsl.

@group(1) @binding(0) var path: texture_2d<f32>;

// Fraction of the light that refraction and reflection divert to other places. Only traced pictures follow it there.
const DIVERTED = 0.5;

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let above = textureLoad(path, vec2u(position.xy), 0).rg;
    if above.g > 0.0 {
        return vec4f(0.0, 0.0, 0.0, 1.0);
    }
    let metres = max(above.r, 0.0);
    let absorbed = exp(-globals.shadow_absorption * metres);
    // Below a thickness of a hundredth of the box the effect fades out.
    let covered = 1.0 - exp(-metres / (2.5 * globals.glass_thickness));
    return vec4f(absorbed * (1.0 - DIVERTED * covered), 1.0);
}
