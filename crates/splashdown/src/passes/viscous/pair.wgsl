// The viscous force of a pair; see pair.rs. Needs `params`.

// (1 - q)(1 - 4/5 q) / r^2 at the square of a distance in m.
fn viscous_weight(r2: f32) -> f32 {
    let q = min(sqrt(r2) / params.support_radius, 1.0);
    return (1.0 - q) * (1.0 - 0.8 * q) / (r2 + 1e-6 * params.support_radius * params.support_radius);
}

// The matrix of a pair for the velocity v of a particle and the velocity u of another one, whose image by a reflection
// with these signs is at the distance d.
fn viscous_pair(v: vec3<f32>, u: vec3<f32>, d: vec3<f32>, sign: vec3<f32>) -> vec3<f32> {
    let slipping = dot(d, v - sign * u) * d;
    if (params.wall_friction == 0.0 || all(sign == vec3(1.0))) {
        return slipping;
    }
    let w = v - sign.x * sign.y * sign.z * u;
    // The products of two components vanish where the reflection changes the sign of one of them.
    let mixed = 0.5 + 0.5 * vec3(sign.x * sign.y, sign.x * sign.z, sign.y * sign.z);
    let a = d * w;
    let sticking = d * vec3(
        a.x + mixed.x * a.y + mixed.y * a.z,
        a.y + mixed.x * a.x + mixed.z * a.z,
        a.z + mixed.y * a.x + mixed.z * a.y,
    );
    return mix(slipping, sticking, params.wall_friction);
}
