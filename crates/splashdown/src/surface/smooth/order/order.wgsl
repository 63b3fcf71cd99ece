#import gpu/index
#import surface/status

@group(0) @binding(0) var<storage, read> status: Status;
@group(0) @binding(1) var<storage, read> ring_starts: array<u32>;
@group(0) @binding(2) var<storage, read_write> rings: array<vec2<u32>>;

@compute @workgroup_size(64)
fn order(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let vertex = linear_index(gid, groups, 64u);
    if vertex >= status.vertices {
        return;
    }
    let start = ring_starts[vertex];
    let end = ring_starts[vertex + 1u];
    // By insertion: a ring has about six members, all different.
    for (var i = start + 1u; i < end; i++) {
        let moved = rings[i];
        var place = i;
        while place > start {
            let lower = rings[place - 1u];
            if lower.x <= moved.x {
                break;
            }
            rings[place] = lower;
            place--;
        }
        rings[place] = moved;
    }
}
