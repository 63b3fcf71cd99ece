#import gpu/index
#import sph/viscous_state
#import sph/grid
#import sph/rows
#import sph/state

#bindings

@compute @workgroup_size(256)
fn viscous_finish(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 256u);
    if (i >= state.run_count || i >= active_count()) {
        return;
    }
    let pressure = iterates[i].yzw;
    let other = accelerations[i].w;
    if (other == 1.0) {
        return;
    }
    let before = sorted_velocities[i].xyz;
    let solution = select(predicted[i].xyz, before, viscous.updates == 0u);
    let u = solution + viscous_residuals[i].xyz;
    accelerations[i] = vec4((u - before) / state.dt - pressure, other);
}
