#import gpu/index
#import sph/foam

#bindings

@compute @workgroup_size(64)
fn compact(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (foam_state.is_due == 1u && i < foam_state.kept) {
        foam_pool[i] = foam_moved[foam_indices[i]];
    }
}
