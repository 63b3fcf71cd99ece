#import gpu/index
#import sort/order

struct SortParams {
    len: u32,
    span: u32,
    flip: u32,
}

#bindings

@compute @workgroup_size(256)
fn sort_step(
    @builtin(global_invocation_id) gid: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let i = linear_index(gid, groups, 256u);
    let half = params.span / 2u;
    let begin = i / half * params.span;
    let low = begin + i % half;
    let high = select(low + half, begin + params.span - 1u - i % half, params.flip == 1u);
    if (high >= params.len) {
        return; // the partner is padding, which stays at the end
    }
    let a = pairs[low];
    let b = pairs[high];
    if (comes_after(a, b)) {
        pairs[low] = b;
        pairs[high] = a;
    }
}
