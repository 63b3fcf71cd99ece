#import gpu/index
#import surface/status

#bindings

@compute @workgroup_size(64)
fn valence(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let triangle = linear_index(gid, groups, 64u);
    if triangle >= status.triangles {
        return;
    }
    let a = indices[3u * triangle];
    let b = indices[3u * triangle + 1u];
    // A triangle with vertices beyond the capacity has equal indices.
    if a == b {
        return;
    }
    atomicAdd(&valences[a], 1u);
    atomicAdd(&valences[b], 1u);
    atomicAdd(&valences[indices[3u * triangle + 2u]], 1u);
}
