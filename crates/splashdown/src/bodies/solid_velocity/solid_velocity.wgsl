#import gpu/index
#import sph/state
#import sph/solve
#import sph/body

#bindings

@compute @workgroup_size(64)
fn solid_velocity(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (solve.stopped != 0u || i >= state.run_count || sorted_positions[i].w != 0.0 || contacts[2u * i].body == NO_BODY) {
        return;
    }
    var approach = 0.0;
    for (var c = 0u; c < 2u; c++) {
        let contact = contacts[2u * i + c];
        let b = contact.body;
        if (b != NO_BODY) {
            let arm = sorted_positions[i].xyz - bodies[b].position;
            let velocity = responses[2u * b].xyz + cross(responses[2u * b + 1u].xyz, arm);
            approach += dot(solid_gradient_of(contact), velocity);
        }
    }
    solid_gradients[i].w = approach;
}
