#import gpu/index
#import sph/params
#import sph/body

#bindings

@compute @workgroup_size(64)
fn boundary_matrix(@builtin(global_invocation_id) gid: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(gid, groups, 64u);
    if (i >= cell_start[arrayLength(&cell_start) - 2u]) {
        return;
    }
    var diagonal = vec4(0.0);
    var others = vec3(0.0);
    for (var k = 0u; k < 2u; k++) {
        let contact = contacts[2u * i + k];
        if (contact.body != NO_BODY) {
            let n = direction(contact, 1.0 / params.support_radius);
            let along = contact.kernel_fraction + length(contact.slope) * max(contact.effective, 0.0);
            diagonal += vec4(along * n * n, contact.kernel_fraction);
            others += along * n.xxy * n.yzz;
        }
    }
    boundary_matrices[2u * i] = diagonal;
    boundary_matrices[2u * i + 1u] = vec4(others, 0.0);
}
