// A small filter in both directions at once, for what two one-dimensional ones leave: streaks along the axes.
// Needs globals.wgsl, narrow_range.wgsl.

// Half of a 5 x 5 neighbourhood from the inside outward; the other half lies opposite.
const OFFSETS = array<vec2i, 12>(
    vec2i(1, 0), vec2i(0, 1), vec2i(1, 1), vec2i(1, -1), vec2i(2, 0), vec2i(0, 2),
    vec2i(2, 1), vec2i(1, 2), vec2i(2, -1), vec2i(1, -2), vec2i(2, 2), vec2i(2, -2),
);

@vertex
fn vertex_main(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    return vec4f(corner * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fragment_main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let here = vec2i(position.xy);
    let own = load(here);
    if own.r >= NOTHING {
        return vec4f(NOTHING, 0.0, 0.0, 0.0);
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
