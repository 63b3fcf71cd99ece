#import gpu/index
#import sph/grid

#bindings

// The order of removed particles, behind the last cell, does not matter. More than this many retain the order of
// arrival: they may be all particles, and comparing all pairs would hang the device.
const MOST_REMOVED_IN_ORDER: u32 = 1024u;

@compute @workgroup_size(64)
fn reorder(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let k = linear_index(gid, groups, 64u);
    if (k >= cell_start[grid.cell_count + 1u]) {
        return;
    }
    let id = entries[k].x;
    let i = entries[k].y;
    let cell = cell_counts[grid.cell_count + 1u + i];
    let begin = cell_start[cell];
    let end = cell_start[cell + 1u];
    var place = k;
    if (cell < grid.cell_count || end - begin <= MOST_REMOVED_IN_ORDER) {
        place = begin;
        for (var m = begin; m < end; m++) {
            place += u32(entries[m].x < id);
        }
    }
    sorted_positions[place] = positions[i];
    sorted_velocities[place] = velocities[i];
    sorted_ids[place] = id;
}
