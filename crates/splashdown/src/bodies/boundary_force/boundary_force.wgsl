#import gpu/index
#import sph/params
#import sph/boundary_law
#import sph/body
#import sph/symmetric
#import sph/reaction

#bindings

override CORRECTED: u32 = 0u; // 1: with corrected gradients

// The acceleration by a body.
fn effect(i: u32, k: u32, other_fraction: f32, other_normal: vec3<f32>, body: vec3<f32>) -> vec3<f32> {
    let contact = contacts[2u * i + k];
    let b = contact.body;
    let x = sorted_positions[i].xyz;
    let scale = 1.0 / params.support_radius;
    let steep = length(contact.slope);
    let n = direction(contact, scale);
    let across = dot(n, other_normal);
    let open = 1.0 - other_fraction * (1.0 - across * across);

    let rho = densities[i].x;
    let pressure = densities[i].y;
    let pressure_factor = params.rest_density * pressure / (rho * rho) + pressure / params.rest_density;
    let effective = max(contact.effective, 0.0);
    var a = vec3(0.0);
    if ((FORCES & PRESSURE_FORCE) != 0u) {
        a = pressure_factor * contact.slope;
        if (pressure_factor > 0.0) {
            a -= (contact.kernel_fraction + steep * effective) * dot(n, body) * n;
        }
        if (CORRECTED == 1u) {
            a *= along(Symmetric(corrections[2u * i].xyz, corrections[2u * i + 1u].xyz), n);
        } else {
            a = a / max(open, 0.1);
        }
    }
    if ((FORCES & OTHER_FORCES) == 0u) {
        return a;
    }

    let wall = bodies[b].velocity + cross(bodies[b].angular_velocity, x - bodies[b].position);
    let v = sorted_velocities[i].xyz - wall;
    let vn = dot(v, n);
    let q = min(effective * scale, 1.0);
    if (vn < 0.0) {
        a -= implicit_rate(approach_damping(q), state.dt) * vn * n;
    }
    let viscosity = params.viscosity + params.boundary_viscosity;
    let friction = boundary_friction(bodies[b].friction, viscosity, steep, effective);
    a -= implicit_rate(friction, state.dt) * (v - vn * n);
    if (q > 0.5) {
        let spline = max(-4.0 * q * q + 6.0 * q - 2.0, 0.0);
        a -= bodies[b].adhesion * sqrt(sqrt(4.0 * spline)) * n;
    }
    return a;
}

// The contact acceleration that prevents a particle from entering the body, if `v` is its velocity after this step.
fn contact_acceleration(i: u32, k: u32, v: vec3<f32>) -> vec3<f32> {
    let contact = contacts[2u * i + k];
    let b = contact.body;
    let x = sorted_positions[i].xyz;
    let wall = bodies[b].velocity + cross(bodies[b].angular_velocity, x - bodies[b].position);
    let slowest = -contact_speed(contact.distance, state.dt);
    let stop = max(slowest - dot(v - wall, contact.normal), 0.0);
    return stop / (yielding(bodies[b].coupling) * state.dt) * contact.normal;
}

@compute @workgroup_size(64)
fn boundary_force(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= state.run_count || sorted_positions[i].w != 0.0 || contacts[2u * i].body == NO_BODY) {
        return;
    }
    let both = contacts[2u * i + 1u].body != NO_BODY;
    let body = body_acceleration(state.time);
    // Body forces are among the other forces, and do not continue into the solid.
    let unchanged = select(vec3(0.0), body, (FORCES & OTHER_FORCES) != 0u);
    var a = accelerations[i].xyz - unchanged;
    var reaction: array<vec3<f32>, 2>;
    for (var k = 0u; k < 2u; k++) {
        if (k == 1u && !both) {
            continue;
        }
        let other_fraction = select(0.0, contacts[2u * i + 1u - k].kernel_fraction, both);
        let other_normal = contacts[2u * i + 1u - k].normal;
        reaction[k] = effect(i, k, other_fraction, other_normal, body);
    }
    var whole = a;
    for (var k = 0u; k < 2u; k++) {
        if (k == 0u || both) {
            // The tangential acceleration continues unchanged into the solid, which exerts the missing part.
            let missing = continued(contacts[2u * i + k], whole, 1.0 / params.support_radius);
            whole += missing;
            reaction[k] += missing;
        }
    }
    a += reaction[0] + reaction[1] + unchanged;
    let v = sorted_velocities[i].xyz;
    for (var k = 0u; k < 2u; k++) {
        if ((FORCES & OTHER_FORCES) != 0u && (k == 0u || both)) {
            let contact = contact_acceleration(i, k, v + state.dt * a);
            a += contact;
            reaction[k] += contact;
        }
    }
    accelerations[i] = vec4(a, 0.0);
    for (var k = 0u; k < 2u; k++) {
        let contact = contacts[2u * i + k];
        if (contact.body != NO_BODY) {
            let x = sorted_positions[i].xyz - contact.distance * contact.normal;
            react(contact.body, x, -params.particle_mass * reaction[k]);
        }
    }
}
