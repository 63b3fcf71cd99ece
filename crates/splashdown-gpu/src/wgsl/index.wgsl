// Beyond 65,535 workgroups a dispatch has two dimensions. These functions return the one-dimensional index of an
// invocation or a workgroup.
fn linear_index(invocation: vec3<u32>, groups: vec3<u32>, workgroup_size: u32) -> u32 {
    return invocation.y * groups.x * workgroup_size + invocation.x;
}

fn linear_group(group: vec3<u32>, groups: vec3<u32>) -> u32 {
    return group.y * groups.x + group.x;
}

// The arguments of an indirect dispatch of at least this many workgroups; `dispatch_groups` in Rust does the same.
fn dispatch_groups(groups: u32) -> vec3<u32> {
    let rows = (max(groups, 1u) - 1u) / 65535u + 1u;
    return vec3<u32>((groups + rows - 1u) / rows, rows, 1u);
}
