// Sums, matrices and velocities of bodies.

// Converts a 64-bit sum to a float. The sign is separated first, because the halves of a small negative number are large.
fn fixed_value(low_word: u32, high_word: u32) -> f32 {
    var low = low_word;
    var high = high_word;
    let negative = (high >> 31u) == 1u;
    if (negative) {
        low = ~low + 1u;
        high = ~high + select(0u, 1u, low == 0u);
    }
    let value = f32(high) * 4294967296.0 + f32(low);
    return select(value, -value, negative);
}

fn symmetric(d: vec3<f32>, p: vec3<f32>) -> mat3x3<f32> {
    return mat3x3(vec3(d.x, p.x, p.y), vec3(p.x, d.y, p.z), vec3(p.y, p.z, d.z));
}

struct BodyVelocities {
    linear: vec3<f32>,
    angular: vec3<f32>,
}
