#import gpu/index
#import sph/state
#import sph/grid

#bindings

// One invocation more than particles: the last one writes the begins of the cells behind the last particle.
@compute @workgroup_size(64)
fn bounds(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let k = linear_index(gid, groups, 64u);
    let n = state.run_count;
    if (k > n) {
        return;
    }
    // The last cell is that of removed particles; one more begin marks its end.
    var here = grid.cell_count + 1u;
    if (k < n) {
        here = pairs[k].x;
        entries[k] = vec2(ids[pairs[k].y], pairs[k].y);
    }
    var first = 0u;
    if (k > 0u) {
        first = pairs[k - 1u].x + 1u;
    }
    for (var cell = first; cell <= here; cell++) {
        cell_start[cell] = k;
    }
}
