#import gpu/index
#import sph/params
#import sph/grid
#import sph/cell_counts

#bindings

// True if the square of the velocity (xyz) and the density (w) are finite.
fn is_moderate(v: vec4<f32>) -> bool {
    return is_finite(vec3(dot(v.xyz, v.xyz), v.w, 0.0));
}

@compute @workgroup_size(64)
fn count(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= state.run_count) {
        return;
    }
    let p = positions[i];
    var cell = grid.cell_count;
    if (p.w == 0.0) {
        if (!is_finite(p.xyz)) {
            positions[i] = vec4(params.domain_min, DEAD_NON_FINITE);
            atomicAdd(&counters[COUNTER_NON_FINITE], 1u);
        } else if (!is_moderate(velocities[i])) {
            positions[i].w = DEAD_NON_FINITE;
            atomicAdd(&counters[COUNTER_NON_FINITE], 1u);
        } else if (is_outside(p.xyz)) {
            positions[i].w = DEAD_ESCAPED;
            atomicAdd(&counters[COUNTER_ESCAPED], 1u);
        } else {
            cell = cell_of(p.xyz);
        }
    }
    // After the last step of a frame no step follows that needs the count.
    if (atomicLoad(&counters[COUNTER_MOVED]) == 0u || !is_last_step(state.dt, state.remaining)) {
        count_particle(i, cell);
    }
}
