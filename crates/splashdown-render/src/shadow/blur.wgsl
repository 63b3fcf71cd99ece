// One direction of a separable Gaussian blur of a map of the floor. Needs fullscreen.wgsl.

@group(0) @binding(0) var source: texture_2d<f32>;

override STEP_X: i32 = 1;
override STEP_Y: i32 = 0;
// Standard deviation in texels.
override SIGMA: f32 = 2.6;

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let here = vec2i(position.xy);
    let last = vec2i(textureDimensions(source)) - 1;
    let reach = i32(ceil(2.3 * SIGMA));
    var sum = vec4f(0.0);
    var weights = 0.0;
    for (var i = -reach; i <= reach; i++) {
        let weight = exp(-0.5 * f32(i * i) / (SIGMA * SIGMA));
        let texel = clamp(here + i * vec2i(STEP_X, STEP_Y), vec2i(0), last);
        sum += weight * textureLoad(source, texel, 0);
        weights += weight;
    }
    return sum / weights;
}
