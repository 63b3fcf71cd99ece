#import gpu/index
#import sph/params
#import sph/viscous_state
#import sph/body
#import sph/viscous_friction
#import sph/reaction

#bindings

@compute @workgroup_size(64)
fn viscous_body_product(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (viscous.stopped != 0u || i >= state.run_count) {
        return;
    }
    viscous_products[i] = vec4(0.0);
    let r = viscous_residuals[i];
    if (sorted_positions[i].w != 0.0 || contacts[2u * i].body == NO_BODY || r.w == 0.0) {
        return;
    }
    let x = sorted_positions[i].xyz;
    var sum = vec3(0.0);
    for (var c = 0u; c < 2u; c++) {
        let contact = contacts[2u * i + c];
        let b = contact.body;
        if (b != NO_BODY) {
            let wall = responses[2u * b].xyz + cross(responses[2u * b + 1u].xyz, x - bodies[b].position);
            let a = friction_rate(contact) * along_surface(contact, r.w * r.xyz - wall);
            sum += a;
            if (bodies[b].kind == BODY_DYNAMIC) {
                react(b, x, params.particle_mass * a);
            }
        }
    }
    viscous_products[i] = vec4(state.dt * sum, 0.0);
}
