#import gpu/index
#import reduce/element

struct ReduceParams {
    len: u32,
    run: u32,
    blocks: u32,
}

@group(0) @binding(0) var<uniform> params: ReduceParams;
@group(0) @binding(1) var<storage, read> values: array<Element>;
@group(0) @binding(2) var<storage, read_write> results: array<Element>;

// 0 sum, 1 smallest, 2 largest
override OPERATION: u32;

var<workgroup> lanes: array<Element, 256>;

fn neutral() -> Element {
    if (OPERATION == 0u) {
        return Element(0.0);
    }
    return Element(select(-3.4028234663852886e38, 3.4028234663852886e38, OPERATION == 1u));
}

fn join(a: Element, b: Element) -> Element {
    if (OPERATION == 0u) {
        return a + b;
    }
    if (OPERATION == 1u) {
        return min(a, b);
    }
    return max(a, b);
}

@compute @workgroup_size(256)
fn reduce(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let block = linear_group(group, groups);
    let first = block * 256u * params.run + lane;
    var joined = neutral();
    for (var i = 0u; i < params.run; i++) {
        let at = first + i * 256u;
        if (at < params.len) {
            joined = join(joined, values[at]);
        }
    }
    lanes[lane] = joined;
    workgroupBarrier();
    if (lane < 16u) {
        var row = lanes[lane * 16u];
        for (var i = 1u; i < 16u; i++) {
            row = join(row, lanes[lane * 16u + i]);
        }
        lanes[lane * 16u] = row;
    }
    workgroupBarrier();
    if (lane == 0u && block < params.blocks) {
        var all = lanes[0];
        for (var row = 1u; row < 16u; row++) {
            all = join(all, lanes[row * 16u]);
        }
        results[block] = all;
    }
}
