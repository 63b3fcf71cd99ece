#import gpu/index
#import sph/viscous_state
#import sph/grid
#import sph/rows
#import sph/state

#bindings

@compute @workgroup_size(256)
fn viscous_update(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 256u);
    if (viscous.stopped != 0u || i >= state.run_count || i >= active_count()) {
        return;
    }
    let r = viscous_residuals[i];
    var p = r.w * r.xyz;
    var s = viscous_products[i].xyz;
    if (viscous.beta != 0.0) {
        p += viscous.beta * viscous_directions[i].xyz;
        s += viscous.beta * viscous_images[i].xyz;
    }
    viscous_directions[i] = vec4(p, 0.0);
    viscous_images[i] = vec4(s, 0.0);
    let before = select(predicted[i].xyz, sorted_velocities[i].xyz, viscous.updates == 1u);
    predicted[i] = vec4(before + viscous.alpha * p, 0.0);
    viscous_residuals[i] = vec4(r.xyz - viscous.alpha * s, r.w);
}
