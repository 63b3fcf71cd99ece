#import gpu/index

struct CompactParams {
    len: u32,
    workgroup_size: u32,
}

#bindings

@compute @workgroup_size(64)
fn compact_gather(
    @builtin(global_invocation_id) gid: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let i = linear_index(gid, groups, 64u);
    let capacity = arrayLength(&indices);
    if (i == 0u) {
        let count = starts[params.len];
        let fitting = min(count, capacity);
        let arguments = dispatch_groups((fitting + params.workgroup_size - 1u) / params.workgroup_size);
        counted[0] = arguments.x;
        counted[1] = arguments.y;
        counted[2] = arguments.z;
        counted[3] = count;
    }
    if (i >= params.len) {
        return;
    }
    let place = starts[i];
    if (starts[i + 1u] != place && place < capacity) {
        indices[place] = i;
    }
}
