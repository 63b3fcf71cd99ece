#import gpu/index
#import sph/params
#import sph/viscous_state
#import sph/body
#import sph/viscous_friction
#import sph/body_algebra
#import sph/viscous_unknowns
#import sph/reaction

#bindings

@compute @workgroup_size(64)
fn viscous_force(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= state.run_count || sorted_positions[i].w != 0.0) {
        return;
    }
    // A nozzle, and not friction, determines the motion where there is no diagonal.
    if (contacts[2u * i].body == NO_BODY || viscous_residuals[i].w == 0.0) {
        return;
    }
    let x = sorted_positions[i].xyz;
    let v = select(predicted[i].xyz, sorted_velocities[i].xyz, viscous.updates == 0u);
    for (var c = 0u; c < 2u; c++) {
        let contact = contacts[2u * i + c];
        let b = contact.body;
        if (b != NO_BODY) {
            let body = unknown(b, UNKNOWN_SOLUTION);
            let wall = body.linear + cross(body.angular, x - bodies[b].position);
            react(b, x, params.particle_mass * friction_rate(contact) * along_surface(contact, v - wall));
        }
    }
}
