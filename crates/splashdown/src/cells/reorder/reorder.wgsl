#import gpu/index
#import sph/grid
#import sph/place

#bindings

@compute @workgroup_size(64)
fn reorder(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let k = linear_index(gid, groups, 64u);
    if (k >= cell_start[grid.cell_count + 1u]) {
        return;
    }
    let id = entries[k].x;
    let i = entries[k].y;
    let place = sorted_index(k, i, id);
    sorted_positions[place] = positions[i];
    sorted_velocities[place] = velocities[i];
    sorted_ids[place] = id;
}
