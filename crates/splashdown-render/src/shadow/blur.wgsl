// One direction of a separable Gaussian blur of the shadow map, which gives soft shadows. Needs
// fullscreen.wgsl.

@group(0) @binding(0) var source: texture_2d<f32>;

override STEP_X: i32 = 1;
override STEP_Y: i32 = 0;

const REACH = 6;
const SIGMA = 2.6;

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
