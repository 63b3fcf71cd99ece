// Past 65,535 workgroups a dispatch has two dimensions: the number of an invocation, or of a workgroup, as if it had one.
fn linear_index(invocation: vec3<u32>, groups: vec3<u32>, workgroup_size: u32) -> u32 {
    return invocation.y * groups.x * workgroup_size + invocation.x;
}

fn linear_group(group: vec3<u32>, groups: vec3<u32>) -> u32 {
    return group.y * groups.x + group.x;
}
