#import gpu/index
#import gpu/workgroup_prefix

struct ScanParams {
    len: u32,
    blocks: u32,
}

#bindings

override RUN: u32 = 16u;
override MOST: u32 = 0xffffffffu; // 1 treats every value other than 0 as 1
override SCANNED: u32 = 0u; // 1 if `sums` already contains prefix sums

// This invocation's part of the sum of the preceding blocks; the parts of all invocations add up to that sum.
// Neighbouring invocations read neighbouring words, and all workgroups read the same words, so they are cached.
fn part_before(block: u32, lane: u32) -> u32 {
    if (SCANNED == 1u) {
        return select(0u, sums[block], lane == 0u);
    }
    var part = 0u;
    for (var i = lane; i < block; i += 256u) {
        part += sums[i];
    }
    return part;
}

@compute @workgroup_size(256)
fn scan_spread(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let block = min(linear_group(group, groups), params.blocks);
    let first = (block * 256u + lane) * RUN;
    let end = min(first + RUN, params.len);
    var sum = 0u;
    for (var i = first; i < end; i++) {
        sum += min(counts[i], MOST);
    }
    let inside = workgroup_prefix(sum, lane, 0u);
    let before = workgroup_prefix(part_before(block, lane), lane, 1u).total;
    var start = before + inside.before;
    for (var i = first; i < end; i++) {
        starts[i] = start;
        start += min(counts[i], MOST);
    }
    if (block + 1u == params.blocks && lane == 0u) {
        starts[params.len] = before + inside.total;
    }
}
