// Adds a sample of the picture to the sum. Needs globals.wgsl, fullscreen.wgsl.

@group(1) @binding(0) var sample_light: texture_2d<f32>;

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let light = textureLoad(sample_light, vec2u(position.xy), 0).rgb;
    // The limit keeps single samples from dominating the average; NaN becomes 0.
    return vec4f(min(max(light, vec3f(0.0)), vec3f(6.0)) / f32(globals.sample_count), 1.0);
}
