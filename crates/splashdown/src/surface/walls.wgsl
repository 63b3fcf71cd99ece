// The closed sides at which the surface ends; see walls.rs. The pass binds `lattice`.

struct WallReflection {
    sign: vec3<f32>,
    shift: vec3<f32>,
}

// The coordinates in front of the walls at which the field has the same value.
fn folded(x: vec3<f32>) -> vec3<f32> {
    let above = select(x, 2.0 * lattice.wall_low - x, x < lattice.wall_low);
    return select(above, 2.0 * lattice.wall_high - above, above > lattice.wall_high);
}

fn folded_x(x: vec4<f32>) -> vec4<f32> {
    let low = vec4<f32>(lattice.wall_low.x);
    let high = vec4<f32>(lattice.wall_high.x);
    let above = select(x, 2.0 * low - x, x < low);
    return select(above, 2.0 * high - above, above > high);
}

// The reflections whose images can be within the search reach of a point in a box: bit k for the
// reflection whose digits of base 3 are 0 for no reflection, 1 for the lower side and 2 for the upper
// side of an axis. Bit 0 stands for the particles themselves.
fn wall_reflections(low: vec3<f32>, high: vec3<f32>) -> u32 {
    let reach = vec3<f32>(lattice.search_reach);
    let near_low = select(vec3<u32>(0u), vec3<u32>(2u), low - lattice.wall_low < reach);
    let near_high = select(vec3<u32>(0u), vec3<u32>(4u), lattice.wall_high - high < reach);
    let digits = vec3<u32>(1u) | near_low | near_high;
    if all(digits == vec3<u32>(1u)) {
        return 1u;
    }
    var found = 0u;
    for (var k = 0u; k < 27u; k++) {
        let is_possible = (digits.x >> (k % 3u)) & (digits.y >> (k / 3u % 3u)) & (digits.z >> (k / 9u)) & 1u;
        found |= is_possible << k;
    }
    return found;
}

fn wall_reflection(k: u32) -> WallReflection {
    let digits = vec3<u32>(k % 3u, k / 3u % 3u, k / 9u);
    let zero = vec3<f32>(0.0);
    let low = select(zero, lattice.wall_low, digits == vec3<u32>(1u));
    let plane = select(low, lattice.wall_high, digits == vec3<u32>(2u));
    return WallReflection(select(vec3<f32>(1.0), vec3<f32>(-1.0), digits > vec3<u32>(0u)), 2.0 * plane);
}

// Distances to the walls of each axis, the nearer one; negative behind it.
fn wall_distances(x: vec3<f32>) -> vec3<f32> {
    return min(x - lattice.wall_low, lattice.wall_high - x);
}

// True if a vertex lies on a wall.
fn is_on_wall(x: vec3<f32>) -> bool {
    return any((x == lattice.wall_low) | (x == lattice.wall_high));
}

// The unit normal of the wall on which a vertex lies; zero if it lies on none.
fn wall_normal(x: vec3<f32>) -> vec3<f32> {
    let sides = vec3<f32>(x == lattice.wall_high) - vec3<f32>(x == lattice.wall_low);
    if sides.x != 0.0 {
        return vec3<f32>(sides.x, 0.0, 0.0);
    }
    if sides.y != 0.0 {
        return vec3<f32>(0.0, sides.y, 0.0);
    }
    return vec3<f32>(0.0, 0.0, sides.z);
}

// The signs of a row of eight nodes, one bit each: inside the fluid and in front of the walls. `low` and `high` are the
// values at its lower and upper four nodes.
fn row_signs(node: vec3<i32>, low: vec4<f32>, high: vec4<f32>) -> u32 {
    let aside = wall_distances(node_position(node));
    if min(aside.y, aside.z) <= lattice.wall_margin {
        return 0u;
    }
    let numbers = vec4<u32>(u32(node.x)) + vec4<u32>(0u, 1u, 2u, 3u);
    let low_x = node_positions_x(numbers);
    let high_x = node_positions_x(numbers + vec4<u32>(4u));
    let low_front = min(low_x - lattice.wall_low.x, lattice.wall_high.x - low_x);
    let high_front = min(high_x - lattice.wall_low.x, lattice.wall_high.x - high_x);
    var inside = 0u;
    for (var i = 0u; i < 4u; i++) {
        inside |= select(0u, 1u << i, low[i] >= lattice.iso_level && low_front[i] > lattice.wall_margin);
        inside |= select(0u, 16u << i, high[i] >= lattice.iso_level && high_front[i] > lattice.wall_margin);
    }
    return inside;
}
