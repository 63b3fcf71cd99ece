#import gpu/index
#import sph/params
#import sph/grid
#import sph/steps

#bindings

@compute @workgroup_size(64)
fn scatter(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i == 0u) {
        finish_step();
    }
    // The number of particles comes from the count: only the first invocation reads the state, which it changes.
    if (i >= cell_start[grid.cell_count + 1u]) {
        return;
    }
    let cell = atomicLoad(&cell_counts[grid.cell_count + 1u + i]);
    let left = atomicSub(&cell_counts[cell], 1u);
    entries[cell_start[cell + 1u] - left] = vec2(ids[i], i);
}
