// Adds a sample of the picture to the mean of the samples before it. Needs globals.wgsl, fullscreen.wgsl.

@group(1) @binding(0) var sample_light: texture_2d<f32>;

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let light = textureLoad(sample_light, vec2u(position.xy), 0).rgb;
    // The limit keeps single samples from dominating the average; NaN becomes 0. Blending by alpha gives the mean. In a
    // sum with 11 bits, samples that are small beside it would be lost: a thousand and more darkened the picture.
    return vec4f(min(max(light, vec3f(0.0)), vec3f(6.0)), 1.0 / f32(globals.sample + 1u));
}
