// The friction of a body on a particle in the implicit viscosity; see friction.rs. Needs `params` and `bodies`.

fn friction_half_space(q: f32) -> f32 {
    let q2 = q * q;
    let third = q2 * q2 * (0.25 - 0.36 * q + q2 / 7.5);
    let first = q2 * (0.5 - 0.6 * q + 0.2 * q2);
    let inverse = log(max(q, 1e-6)) - 1.8 * q + 0.4 * q2;
    return 0.07 / 3.0 - third - 2.0 * q2 * (0.1 - first) - q2 * q2 * (1.4 + inverse);
}

fn friction_rate(contact: Contact) -> f32 {
    let effective = max(contact.effective, 0.0);
    let q = min(effective / params.support_radius, 1.0);
    let distance = max(effective, 0.25 * params.particle_spacing);
    let integral = 131.25 * max(friction_half_space(q), 0.0) / (params.support_radius * distance);
    return bodies[contact.body].friction * params.implicit_viscosity * integral;
}

fn along_surface(contact: Contact, v: vec3<f32>) -> vec3<f32> {
    let n = direction(contact, 1.0 / params.support_radius);
    return v - dot(v, n) * n;
}
