#bindings

@compute @workgroup_size(1)
fn nothing() {
    counter[0] += 1u;
}
