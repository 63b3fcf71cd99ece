#import gpu/index
#import gpu/workgroup_prefix

struct ScanParams {
    len: u32,
    blocks: u32,
}

#bindings

override RUN: u32 = 16u;
override MOST: u32 = 0xffffffffu; // 1 treats every value other than 0 as 1

@compute @workgroup_size(256)
fn scan_reduce(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let block = linear_group(group, groups);
    let first = block * 256u * RUN + lane;
    var sum = 0u;
    // Neighbouring invocations read neighbouring words: the order of the sum over a block is arbitrary.
    for (var i = 0u; i < RUN; i++) {
        let at = first + i * 256u;
        if (at < params.len) {
            sum += min(counts[at], MOST);
        }
    }
    let prefix = workgroup_prefix(sum, lane, 0u);
    if (lane == 0u && block < params.blocks) {
        sums[block] = prefix.total;
    }
}
