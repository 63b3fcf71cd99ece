// Small two-dimensional filter that removes the streaks along the axes left by the separable
// filter. Needs globals.wgsl, narrow_range.wgsl, fullscreen.wgsl.

// Half of a 5 x 5 neighbourhood, from the inside outwards; the other half is its mirror image.
const OFFSETS = array<vec2i, 12>(
    vec2i(1, 0), vec2i(0, 1), vec2i(1, 1), vec2i(1, -1), vec2i(2, 0), vec2i(0, 2),
    vec2i(2, 1), vec2i(1, 2), vec2i(2, -1), vec2i(1, -2), vec2i(2, 2), vec2i(2, -2),
);

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let here = vec2i(position.xy);
    let own = load(here);
    if own.r >= NO_LIQUID {
        return vec4f(NO_LIQUID, 0.0, 0.0, 0.0);
    }
    var offsets = OFFSETS;
    var state = filter_begin(own.r);
    for (var i = 0u; i < 12u; i++) {
        let offset = offsets[i];
        let weight = exp(-0.35 * f32(dot(offset, offset)));
        filter_add(&state, sample_distance(here + offset), sample_distance(here - offset), weight);
    }
    return vec4f(state.sum / state.weights, own.g, 0.0, 0.0);
}
