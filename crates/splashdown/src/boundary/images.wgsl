// The images of the fluid behind closed sides; see images.rs. Needs `params`.

struct Reflection {
    sign: vec3<f32>,
    shift: vec3<f32>,
}

fn is_side_near(bit: u32, distance: f32) -> u32 {
    return select(0u, 1u, ((params.closed >> bit) & 1u) == 1u && distance < params.support_radius);
}

// The reflections whose images of the fluid can be within the support of a point: bit k for the reflection whose digits
// of base 3 are 0 for no reflection, 1 for the lower side and 2 for the upper side of an axis. Bit 0 is the fluid itself.
fn reflections_near(x: vec3<f32>) -> u32 {
    let low = x - params.domain_min;
    let high = params.domain_max - x;
    // Bits of the digits that are possible, per axis. A digit of y stands for three reflections, one of z for nine: a
    // product repeats the bits of the axes before.
    let x_bits = 1u + (is_side_near(0u, low.x) << 1u) + (is_side_near(1u, high.x) << 2u);
    let y_bits = 1u + (is_side_near(2u, low.y) << 3u) + (is_side_near(3u, high.y) << 6u);
    let z_bits = 1u + (is_side_near(4u, low.z) << 9u) + (is_side_near(5u, high.z) << 18u);
    return x_bits * y_bits * z_bits;
}

fn reflection(k: u32) -> Reflection {
    let digits = vec3(k % 3u, k / 3u % 3u, k / 9u);
    var by: Reflection;
    by.sign = select(vec3(1.0), vec3(-1.0), digits > vec3(0u));
    by.shift = 2.0 * select(select(vec3(0.0), params.domain_min, digits == vec3(1u)), params.domain_max, digits == vec3(2u));
    return by;
}

// The pressure of an image, or a multiple of it, for that of the particle and the hydrostatic difference `more`.
fn extrapolated(pressure: f32, more: f32) -> f32 {
    return max(pressure + more, min(pressure, 0.0));
}

// A reflection is its own inverse, so a loop over neighbours can reflect the particle once instead of every neighbour:
// reflected_point(by, x) - p is by.sign times the distance of x from the image of p. Scalars of the pair are the same in
// both frames. Loops keep their sums in the frame of the image, by a product with by.sign before and after.
fn reflected_point(by: Reflection, x: vec3<f32>) -> vec3<f32> {
    return select(x, by.shift - x, by.sign < vec3(0.0));
}
