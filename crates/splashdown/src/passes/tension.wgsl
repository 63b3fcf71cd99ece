// Surface tension between two particles; see tension.rs. Needs `params`, `normals` and the kernels.
var<private> own_normal: vec3<f32>;

// Akinci's cohesion kernel times H^3; both branches agree at q = 1/2.
fn cohesion(q: f32) -> f32 {
    let t = (1.0 - q) * q;
    let t3 = t * t * t;
    return 32.0 / PI * select(t3, 2.0 * t3 - 1.0 / 64.0, q <= 0.5);
}

// The acceleration by the image of particle j that has the reflection `sign`, where d is the distance from the image.
fn tension_between(
    i: u32,
    j: u32,
    sign: vec3<f32>,
    d: vec3<f32>,
    q: f32,
    rho_i: f32,
    rho_j: f32,
) -> vec3<f32> {
    let scale = 1.0 / params.support_radius;
    let k = -params.surface_tension * 2.0 * params.rest_density / (rho_i + rho_j);
    let pull = params.summed_mass * scale * scale * scale * scale * cohesion(q) / max(q, SMALLEST_Q);
    return k * (pull * d + own_normal - sign * normals[j].xyz);
}
