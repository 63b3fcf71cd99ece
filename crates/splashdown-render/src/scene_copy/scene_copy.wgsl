// Copies the picture without the liquid. Needs fullscreen.wgsl.

@group(0) @binding(0) var scene: texture_2d<f32>;

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return textureLoad(scene, vec2u(position.xy), 0);
}
