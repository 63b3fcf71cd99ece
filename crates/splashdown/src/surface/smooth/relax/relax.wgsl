#import gpu/index
#import surface/status

#bindings

@compute @workgroup_size(64)
fn relax(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let vertex = linear_index(gid, groups, 64u);
    if vertex >= status.vertices {
        return;
    }
    let start = one_ring_starts[vertex];
    let end = one_ring_starts[vertex + 1u];
    let own = before[vertex];
    var sum = vec3<f32>(0.0);
    for (var i = start; i < end; i++) {
        // Relative to the vertex, which avoids cancellation far from the origin.
        sum += before[one_rings[i].x].xyz - own.xyz;
    }
    let count = f32(max(end - start, 1u));
    after[vertex] = vec4<f32>(own.xyz + sum * (own.w / count), own.w);
}
