#import gpu/index
#import surface/status

#bindings

@compute @workgroup_size(64)
fn one_ring(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let triangle = linear_index(gid, groups, 64u);
    if triangle >= status.triangles {
        return;
    }
    let corners = vec3<u32>(indices[3u * triangle], indices[3u * triangle + 1u], indices[3u * triangle + 2u]);
    if corners.x == corners.y {
        return;
    }
    for (var k = 0u; k < 3u; k++) {
        let v = corners[k];
        let place = atomicSub(&valences[v], 1u) - 1u;
        one_rings[one_ring_starts[v] + place] = vec2<u32>(corners[(k + 1u) % 3u], corners[(k + 2u) % 3u]);
    }
}
