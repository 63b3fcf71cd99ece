#import gpu/index
#import sph/params
#import sph/viscous_state
#import sph/body
#import sph/viscous_friction
#import sph/reaction

#bindings

@compute @workgroup_size(64)
fn viscous_friction(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (viscous.stopped != 0u || i >= state.run_count || sorted_positions[i].w != 0.0) {
        return;
    }
    var r = viscous_residuals[i];
    if (contacts[2u * i].body == NO_BODY || r.w == 0.0) {
        return;
    }
    let x = sorted_positions[i].xyz;
    var rates = 0.0;
    for (var c = 0u; c < 2u; c++) {
        let contact = contacts[2u * i + c];
        let b = contact.body;
        if (b != NO_BODY) {
            let rate = friction_rate(contact);
            let wall = bodies[b].velocity + cross(bodies[b].angular_velocity, x - bodies[b].position);
            let a = rate * along_surface(contact, sorted_velocities[i].xyz - wall);
            r = vec4(r.xyz - state.dt * a, r.w);
            rates += rate;
            if (bodies[b].kind == BODY_DYNAMIC) {
                react(b, x, params.particle_mass * a);
            }
        }
    }
    viscous_residuals[i] = vec4(r.xyz, 1.0 / (1.0 / r.w + state.dt * rates * 2.0 / 3.0));
}
