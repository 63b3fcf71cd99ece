#import gpu/index
#import surface/lattice
#import surface/walls

#bindings

@compute @workgroup_size(64)
fn vertex_normals(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let vertex = linear_index(gid, groups, 64u);
    if vertex >= status.vertices {
        return;
    }
    let own = vertex_positions[vertex].xyz;
    let of_wall = wall_normal(own);
    if any(of_wall != vec3<f32>(0.0)) {
        normals[vertex] = vec4<f32>(of_wall, 0.0);
        return;
    }
    var sum = vec3<f32>(0.0);
    for (var i = one_ring_starts[vertex]; i < one_ring_starts[vertex + 1u]; i++) {
        let pair = one_rings[i];
        let first = vertex_positions[pair.x].xyz;
        let second = vertex_positions[pair.y].xyz;
        if !is_on_wall(first) && !is_on_wall(second) {
            sum += cross(first - own, second - own);
        }
    }
    // If the triangles have no area, the normal from the field remains.
    let scale = max(abs(sum.x), max(abs(sum.y), abs(sum.z)));
    if scale > 1e-30 {
        normals[vertex] = vec4<f32>(normalize(sum / scale), 0.0);
    }
}
