#import gpu/index
#import sph/params
#import sph/solve
#import sph/grid
#import sph/rows

#bindings

fn reset() {
    solve.stopped = select(0u, 1u, state.run_count == 0u);
    solve.iteration = 0u;
    solve.beta = 0.0;
    solve.relaxation = params.relaxation;
    solve.change = 0.0;
    solve.best = 3.4028234e38;
    solve.warm_start = 1.0;
    solve.scale = 1.0;
    solve.renewal = 1.0;
    let longest = longest_step(max(state.max_speed, state.body_speed), 0.0, 0.0);
    solve.dt_ratio = min(state.dt / longest, 1.0);
    solve.advanced_part = 1.0;
    solve.mean_excess = 0.0;
}

@compute @workgroup_size(64)
fn implicit_begin(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i == 0u && state.done != SUSPENDED) {
        reset();
    }
    if (i >= active_count()) {
        return;
    }
    let excess = densities[i].x / params.rest_density - 1.0;
    iterates[i] = vec4(sorted_pressures[i], 0.0, 0.0, excess);
    let other = accelerations[i];
    free_velocities[i] = vec4(sorted_velocities[i].xyz + state.dt * other.xyz, other.w);
}
