// The candidates of a row that are neighbours. Needs `params` and `sorted_positions`.
const CANDIDATES: u32 = 32u;

// Which of the next 32 particles of a row that ends at `end` are within the support of a point: one bit each. The tests
// load four positions at a time, which overlaps their latencies. A loop over the bits executes the formula of a pair as
// often as the particle of a warp with the most neighbours among these candidates needs it; a branch per candidate would
// execute it for nearly each of them.
fn neighbour_bits(x: vec3<f32>, first: u32, end: u32) -> u32 {
    let reach = vec4(params.support_radius * params.support_radius);
    let last = end - 1u;
    var bits = 0u;
    for (var j = first; j < min(first + CANDIDATES, end); j += 4u) {
        let a = x - sorted_positions[j].xyz;
        let b = x - sorted_positions[min(j + 1u, last)].xyz;
        let c = x - sorted_positions[min(j + 2u, last)].xyz;
        let d = x - sorted_positions[min(j + 3u, last)].xyz;
        let is_near = vec4(dot(a, a), dot(b, b), dot(c, c), dot(d, d)) < reach;
        let is_neighbour = is_near & (vec4(j, j + 1u, j + 2u, j + 3u) < vec4(end));
        let four = select(vec4(0u), vec4(1u, 2u, 4u, 8u), is_neighbour);
        bits |= (four.x | four.y | four.z | four.w) << (j - first);
    }
    return bits;
}
