// Tone mapping of the mean of the samples. Needs globals.wgsl, fullscreen.wgsl.

@group(1) @binding(0) var mean: texture_2d<f32>;

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return vec4f(encode(film(textureLoad(mean, vec2u(position.xy), 0).rgb)), 1.0);
}
