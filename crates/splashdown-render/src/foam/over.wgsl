// Draws the layer of foam over the picture. Needs fullscreen.wgsl.

// Colours times opacity, and the opacity.
@group(0) @binding(0) var layer: texture_2d<f32>;

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let foam = textureLoad(layer, vec2u(position.xy), 0);
    if foam.a == 0.0 {
        discard;
    }
    return foam;
}
