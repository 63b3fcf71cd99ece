#import gpu/index

#bindings

@compute @workgroup_size(256)
fn copy(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear_index(id, groups, 256u);
    if (i < arrayLength(&values)) {
        results[i] = values[i];
    }
}
