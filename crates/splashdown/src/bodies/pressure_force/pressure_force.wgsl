#import gpu/index
#import sph/params
#import sph/boundary_law
#import sph/body
#import sph/reaction

#bindings

@compute @workgroup_size(64)
fn pressure_force(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= state.run_count || sorted_positions[i].w != 0.0) {
        return;
    }
    let whole = accelerations[i];
    if (contacts[2u * i].body == NO_BODY || whole.w == 1.0) {
        return;
    }
    let x = sorted_positions[i].xyz;
    let pressure = predicted[i].w;
    let by_pressure = predicted[i].xyz;
    let scale = 1.0 / params.support_radius;
    var a = whole.xyz;
    for (var c = 0u; c < 2u; c++) {
        let contact = contacts[2u * i + c];
        let b = contact.body;
        if (b != NO_BODY) {
            let missing = continued(contact, by_pressure, scale);
            a += missing;
            let wall = bodies[b].velocity + cross(bodies[b].angular_velocity, x - bodies[b].position);
            let v = sorted_velocities[i].xyz + state.dt * a - wall;
            let slowest = -contact_speed(contact.distance, state.dt);
            let rate = max(slowest - dot(v, contact.normal), 0.0) / (yielding(bodies[b].coupling) * state.dt);
            let stop = rate * contact.normal;
            a += stop;
            let force = params.particle_mass * (pressure * solid_gradient_of(contact) - stop - missing);
            react(b, x - contact.distance * contact.normal, force);
        }
    }
    accelerations[i] = vec4(a, 0.0);
}
