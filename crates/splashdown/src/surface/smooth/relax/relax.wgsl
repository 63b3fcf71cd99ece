#import gpu/index
#import surface/lattice
#import surface/walls

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
    var free = 0u;
    var pinned = 0u;
    for (var i = start; i < end; i++) {
        let at = before[one_rings[i].x];
        if at.w == 0.0 {
            pinned++;
        } else if !is_on_wall(at.xyz) {
            // Relative to the vertex, which avoids cancellation far from the origin.
            sum += at.xyz - own.xyz;
            free++;
        }
    }
    // Pinned neighbours hold the vertex, or it would move onto the few others and turn triangles over.
    let share = f32(free) / f32(max(free + pinned, 1u));
    let factor = own.w * share * share / f32(max(free, 1u));
    let clear = vec3<f32>((LAYER_MARGINS + 2.0) * lattice.wall_margin);
    let moved = own.xyz + sum * factor;
    let inside = max(min(moved, lattice.wall_high - clear), lattice.wall_low + clear);
    let beside_wall = wall_distances(own.xyz) <= vec3<f32>((LAYER_MARGINS + 1.0) * lattice.wall_margin);
    after[vertex] = vec4<f32>(select(inside, own.xyz, beside_wall), own.w);
}
