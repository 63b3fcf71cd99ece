// Adds the light of every ray to the texel of the floor or of a layer of the bodies where it arrives. Needs globals.wgsl,
// sun_layers.wgsl.

// 1: the rays that arrive at bodies; 0: those that arrive at the floor.
override BODIES: u32 = 0u;

@group(1) @binding(0) var arrivals: texture_2d<f32>;    // place, path in liquid, light: see photons.wgsl

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) light: vec3f,
}

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> Varying {
    let side = textureDimensions(arrivals).x;
    let arrival = textureLoad(arrivals, vec2u(index % side, index / side), 0);
    let layer = floor(0.5 * arrival.x) - 1.0;
    var uv = arrival.xy;
    if BODIES == 1u {
        uv = (vec2f(layer % TILES, floor(layer / TILES)) + vec2f(uv.x - 2.0 * (layer + 1.0), uv.y)) / TILES;
    }
    var out: Varying;
    out.position = vec4f(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y, 0.5, 1.0);
    if arrival.x < 0.0 || (layer >= 0.0) != (BODIES == 1u) {
        out.position = vec4f(2.0, 2.0, 2.0, 1.0);
    }
    out.light = arrival.w * exp(-globals.shadow_absorption * arrival.z);
    return out;
}

@fragment
fn fragment_main(in: Varying) -> @location(0) vec4f {
    return vec4f(in.light, 0.0);
}
