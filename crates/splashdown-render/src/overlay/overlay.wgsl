// A prepared image (colour bar, caption) drawn over the finished picture, one texel per pixel.

struct Placement {
    corner: vec2f,          // pixels from the upper left of the target
    size: vec2f,
    target_size: vec2f,
    encode_srgb: u32,
    pad: u32,
}

@group(0) @binding(0) var<uniform> placement: Placement;
@group(0) @binding(1) var pixels: texture_2d<f32>;

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let pixel = placement.corner + placement.size * vec2f(f32(index & 1u), f32(index >> 1u));
    let ndc = pixel / placement.target_size * 2.0 - 1.0;
    return vec4f(ndc.x, -ndc.y, 0.0, 1.0);
}

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let texel = textureLoad(pixels, vec2i(position.xy - placement.corner), 0);
    if placement.encode_srgb == 1u {
        let high = 1.055 * pow(texel.rgb, vec3f(1.0 / 2.4)) - 0.055;
        return vec4f(select(high, 12.92 * texel.rgb, texel.rgb <= vec3f(0.0031308)), texel.a);
    }
    return texel;
}
