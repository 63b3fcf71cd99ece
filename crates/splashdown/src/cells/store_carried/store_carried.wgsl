#import gpu/index
#import sph/state

#bindings

@compute @workgroup_size(64)
fn store_carried(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i < state.run_count) {
        carried[i] = sorted_carried[i];
    }
}
