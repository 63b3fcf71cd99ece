// Directions as two integers of 16 bits, with an error below 1e-4 radians: a point on an octahedron,
// unfolded to a square (Cigolle et al. 2014).

// No surface; also the value of a cleared texture.
const NO_SURFACE = vec2u(0u, 0u);
// A surface whose normal is zero or not a number.
const NO_DIRECTION = vec2u(1u, 0u);

// Folds the lower half of the octahedron outwards; its own inverse.
fn folded(p: vec2f) -> vec2f {
    return (1.0 - abs(p.yx)) * select(vec2f(-1.0), vec2f(1.0), p >= vec2f(0.0));
}

// The code of a normal of any length; both integers of a direction are at least 1.
fn code_of_normal(normal: vec3f) -> vec2u {
    let size = abs(normal.x) + abs(normal.y) + abs(normal.z);
    let p = normal / size;
    let square = select(folded(p.xy), p.xy, p.z >= 0.0);
    let code = vec2u(clamp(square, vec2f(-1.0), vec2f(1.0)) * 32767.0 + 32768.5);
    return select(NO_DIRECTION, code, size > 1e-20 && size < 1e20);
}

// The unit vector of a code, or zero for NO_DIRECTION.
fn normal_of_code(code: vec2u) -> vec3f {
    if code.y == 0u {
        return vec3f(0.0);
    }
    let square = (vec2f(code) - 32768.0) / 32767.0;
    let height = 1.0 - abs(square.x) - abs(square.y);
    return normalize(vec3f(select(folded(square), square, height >= 0.0), height));
}
