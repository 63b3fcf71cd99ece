// Copies the depth of the first sample of each pixel. Needs fullscreen.wgsl.

@group(0) @binding(0) var depths: texture_depth_multisampled_2d;

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> @builtin(frag_depth) f32 {
    return textureLoad(depths, vec2u(position.xy), 0);
}
