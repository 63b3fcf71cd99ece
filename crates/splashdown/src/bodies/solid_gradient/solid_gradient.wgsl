#import gpu/index
#import sph/params
#import sph/body

#bindings

@compute @workgroup_size(64)
fn solid_gradient(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= state.run_count || sorted_positions[i].w != 0.0) {
        return;
    }
    var sum = vec3(0.0);
    var approach = 0.0;
    var more = 0.0;
    for (var c = 0u; c < 2u; c++) {
        let contact = contacts[2u * i + c];
        let b = contact.body;
        if (b != NO_BODY) {
            let gradient = solid_gradient_of(contact);
            let arm = sorted_positions[i].xyz - bodies[b].position;
            sum += gradient;
            approach += dot(gradient, bodies[b].velocity + cross(bodies[b].angular_velocity, arm));
            more += params.rest_density * bodies[b].coupling * length(gradient);
        }
    }
    solid_gradients[i] = vec4(sum, approach);
    stiffness[i].w += more;
}
