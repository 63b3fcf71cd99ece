// A number of workgroups in two dimensions, neither past the 65,535 that every device grants.
fn spread(groups: u32) -> vec3<u32> {
    let rows = (groups + 65534u) / 65535u;
    return vec3<u32>(min(groups, 65535u), rows, 1u);
}
