// A symmetric matrix: the elements xx, yy, zz, and xy, xz, yz.
struct Symmetric {
    diagonal: vec3<f32>,
    others: vec3<f32>,
}

fn contract(a: Symmetric, b: Symmetric) -> f32 {
    return dot(a.diagonal, b.diagonal) + 2.0 * dot(a.others, b.others);
}

// m v.
fn applied(m: Symmetric, v: vec3<f32>) -> vec3<f32> {
    return m.diagonal * v
        + vec3(
            m.others.x * v.y + m.others.y * v.z,
            m.others.x * v.x + m.others.z * v.z,
            m.others.y * v.x + m.others.z * v.y,
        );
}

// v.(m v).
fn along(m: Symmetric, v: vec3<f32>) -> f32 {
    return dot(v, applied(m, v));
}
