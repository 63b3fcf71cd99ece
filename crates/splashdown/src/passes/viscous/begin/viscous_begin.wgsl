#import gpu/index
#import sph/state
#import sph/viscous_state
#import sph/grid
#import sph/rows

#bindings

fn reset() {
    viscous.stopped = select(0u, 1u, state.run_count == 0u);
    viscous.iteration = 0u;
    viscous.updates = 0u;
    viscous.alpha = 0.0;
    viscous.beta = 0.0;
    viscous.gamma = 0.0;
    viscous.reference = 0.0;
    viscous.target_residual = 0.0;
}

@compute @workgroup_size(64)
fn viscous_begin(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i == 0u && state.done != SUSPENDED) {
        reset();
    }
    if (i < active_count()) {
        iterates[i] = vec4(max(sorted_pressures[i], 0.0), 0.0, 0.0, 0.0);
    }
}
