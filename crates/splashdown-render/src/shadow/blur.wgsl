// One direction of a Gaussian blur of the shadow map, so that shadows have the soft edge of a broad light.

@group(0) @binding(0) var source: texture_2d<f32>;

override STEP_X: i32 = 1;
override STEP_Y: i32 = 0;

const REACH = 6;
const SIGMA = 2.6;

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    return vec4f(corner * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let here = vec2i(position.xy);
    let last = vec2i(textureDimensions(source)) - 1;
    var sum = 0.0;
    var weights = 0.0;
    for (var i = -REACH; i <= REACH; i++) {
        let weight = exp(-0.5 * f32(i * i) / (SIGMA * SIGMA));
        let texel = clamp(here + i * vec2i(STEP_X, STEP_Y), vec2i(0), last);
        sum += weight * textureLoad(source, texel, 0).r;
        weights += weight;
    }
    return vec4f(sum / weights, 0.0, 0.0, 0.0);
}
