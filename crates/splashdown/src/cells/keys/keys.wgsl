#import gpu/index
#import sph/state
#import sph/grid

#bindings

@compute @workgroup_size(64)
fn keys(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= state.run_count) {
        return;
    }
    pairs[i] = vec2(cell_counts[grid.cell_count + 1u + i], i);
}
