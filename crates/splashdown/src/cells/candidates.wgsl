// The candidates of a row that are neighbours. Needs `params` and `sorted_positions`.
const CANDIDATES: u32 = 32u;

// Which of the next 32 particles of a row that ends at `end` are within the support of a point: one bit each. The tests
// load eight positions at a time, which overlaps their latencies. A loop over the bits executes the formula of a pair as
// often as the particle of a warp with the most neighbours among these candidates needs it; a branch per candidate would
// execute it for nearly each of them.
fn neighbour_bits(x: vec3<f32>, first: u32, end: u32) -> u32 {
    let reach = vec4(params.support_radius * params.support_radius);
    let last = end - 1u;
    var bits = 0u;
    for (var j = first; j < min(first + CANDIDATES, end); j += 8u) {
        let a = x - sorted_positions[j].xyz;
        let b = x - sorted_positions[min(j + 1u, last)].xyz;
        let c = x - sorted_positions[min(j + 2u, last)].xyz;
        let d = x - sorted_positions[min(j + 3u, last)].xyz;
        let e = x - sorted_positions[min(j + 4u, last)].xyz;
        let f = x - sorted_positions[min(j + 5u, last)].xyz;
        let g = x - sorted_positions[min(j + 6u, last)].xyz;
        let h = x - sorted_positions[min(j + 7u, last)].xyz;
        let low = bits_of(vec4(dot(a, a), dot(b, b), dot(c, c), dot(d, d)) < reach);
        let high = bits_of(vec4(dot(e, e), dot(f, f), dot(g, g), dot(h, h)) < reach);
        // The particles behind the end are the last one again.
        let there = (1u << min(end - j, 8u)) - 1u;
        bits |= ((low | (high << 4u)) & there) << (j - first);
    }
    return bits;
}

fn bits_of(flags: vec4<bool>) -> u32 {
    let bits = select(vec4(0u), vec4(1u, 2u, 4u, 8u), flags);
    return bits.x | bits.y | bits.z | bits.w;
}
