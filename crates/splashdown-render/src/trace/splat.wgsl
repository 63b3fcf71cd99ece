// Adds the light of every ray to the texel of the floor where it arrives. Needs globals.wgsl.

@group(1) @binding(0) var arrivals: texture_2d<f32>;    // place on the floor, path in liquid, light

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) light: vec3f,
}

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> Varying {
    let side = textureDimensions(arrivals).x;
    let arrival = textureLoad(arrivals, vec2u(index % side, index / side), 0);
    let uv = arrival.xy;
    var out: Varying;
    out.position = vec4f(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y, 0.5, 1.0);
    if !(all(uv > vec2f(0.0)) && all(uv < vec2f(1.0))) {
        out.position = vec4f(2.0, 2.0, 2.0, 1.0);
    }
    out.light = arrival.w * exp(-globals.shadow_absorption * arrival.z);
    return out;
}

@fragment
fn fragment_main(in: Varying) -> @location(0) vec4f {
    return vec4f(in.light, 0.0);
}
