#import gpu/index
#import sort/order

struct SortParams {
    len: u32,
    span: u32,
    flip: u32,
}

#bindings

// 1: sorts each block of 512. 0: only the last merge, of spans from 512 down.
override WHOLE: u32;

var<workgroup> local: array<vec2<u32>, 512>;

fn compare(low: u32, high: u32) {
    let a = local[low];
    let b = local[high];
    if (comes_after(a, b)) {
        local[low] = b;
        local[high] = a;
    }
}

// The halves of every span, each pair `span / 2` apart.
fn disperse(lane: u32, largest: u32) {
    for (var span = largest; span > 1u; span /= 2u) {
        let half = span / 2u;
        let low = lane / half * span + lane % half;
        compare(low, low + half);
        workgroupBarrier();
    }
}

@compute @workgroup_size(256)
fn sort_local(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let first = linear_group(group, groups) * 512u;
    for (var i = lane; i < 512u; i += 256u) {
        local[i] = vec2<u32>(0xffffffffu);
        if (first + i < params.len) {
            local[i] = pairs[first + i];
        }
    }
    workgroupBarrier();
    if (WHOLE == 1u) {
        for (var span = 2u; span <= 512u; span *= 2u) {
            let half = span / 2u;
            let begin = lane / half * span;
            compare(begin + lane % half, begin + span - 1u - lane % half);
            workgroupBarrier();
            disperse(lane, half);
        }
    } else {
        disperse(lane, 512u);
    }
    for (var i = lane; i < 512u; i += 256u) {
        if (first + i < params.len) {
            pairs[first + i] = local[i];
        }
    }
}
