#import gpu/index
#import sph/grid
#import sph/place

#bindings

@compute @workgroup_size(64)
fn reorder_carried(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let k = linear_index(gid, groups, 64u);
    if (k >= cell_start[grid.cell_count + 1u]) {
        return;
    }
    let entry = entries[k];
    let index = sorted_index(k, entry.y, entry.x);
    if (index < cell_start[grid.cell_count]) {
        sorted_carried[index] = carried[entry.y];
    } else {
        sorted_carried[index] = emitted[0];
    }
}
