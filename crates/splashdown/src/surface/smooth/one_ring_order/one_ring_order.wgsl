#import gpu/index
#import surface/status

#bindings

@compute @workgroup_size(64)
fn one_ring_order(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let vertex = linear_index(gid, groups, 64u);
    if vertex >= status.vertices {
        return;
    }
    let start = one_ring_starts[vertex];
    let end = one_ring_starts[vertex + 1u];
    // Insertion sort: a one-ring has about six entries, all different.
    for (var i = start + 1u; i < end; i++) {
        let moved = one_rings[i];
        var place = i;
        while place > start {
            let lower = one_rings[place - 1u];
            if lower.x <= moved.x {
                break;
            }
            one_rings[place] = lower;
            place--;
        }
        one_rings[place] = moved;
    }
}
