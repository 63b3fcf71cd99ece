// Adds a sample of the picture to the mean of the samples before it. Needs globals.wgsl, fullscreen.wgsl.

@group(1) @binding(0) var sample_light: texture_2d<f32>;
@group(2) @binding(0) var earlier: texture_2d<f32>;

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2u(position.xy);
    // The limit keeps single samples from dominating the average; NaN becomes 0.
    let light = min(max(textureLoad(sample_light, pixel, 0).rgb, vec3f(0.0)), vec3f(6.0));
    if globals.sample == 0u {
        return vec4f(light, 1.0);
    }
    return vec4f(mix(textureLoad(earlier, pixel, 0).rgb, light, 1.0 / f32(globals.sample + 1u)), 1.0);
}
