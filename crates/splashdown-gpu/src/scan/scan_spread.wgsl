#import gpu/index
#import gpu/workgroup_prefix

struct ScanParams {
    len: u32,
    blocks: u32,
}

@group(0) @binding(0) var<uniform> params: ScanParams;
@group(0) @binding(1) var<storage, read> counts: array<u32>;
@group(0) @binding(2) var<storage, read> offsets: array<u32>;
@group(0) @binding(3) var<storage, read_write> starts: array<u32>;

override RUN: u32 = 16u;
override MOST: u32 = 0xffffffffu; // 1 counts flags, whatever their value

@compute @workgroup_size(256)
fn scan_spread(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let block = linear_group(group, groups);
    let first = (block * 256u + lane) * RUN;
    let end = min(first + RUN, params.len);
    var sum = 0u;
    for (var i = first; i < end; i++) {
        sum += min(counts[i], MOST);
    }
    let prefix = workgroup_prefix(sum, lane, 0u);
    var start = offsets[min(block, params.blocks)] + prefix.before;
    for (var i = first; i < end; i++) {
        starts[i] = start;
        start += min(counts[i], MOST);
    }
    if (block == 0u && lane == 0u) {
        starts[params.len] = offsets[params.blocks];
    }
}
