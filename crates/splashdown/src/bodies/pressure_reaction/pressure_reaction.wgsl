#import gpu/index
#import sph/params
#import sph/solve
#import sph/body
#import sph/reaction

#bindings

@compute @workgroup_size(64)
fn pressure_reaction(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (solve.stopped != 0u || i >= state.run_count || sorted_positions[i].w != 0.0 || predicted[i].w == NO_PRESSURE) {
        return;
    }
    for (var c = 0u; c < 2u; c++) {
        let contact = contacts[2u * i + c];
        if (contact.body != NO_BODY && bodies[contact.body].kind == BODY_DYNAMIC) {
            let x = sorted_positions[i].xyz - contact.distance * contact.normal;
            react(contact.body, x, params.particle_mass * predicted[i].w * solid_gradient_of(contact));
        }
    }
}
