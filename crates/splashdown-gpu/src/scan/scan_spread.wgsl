#import gpu/index
#import gpu/workgroup_prefix

struct ScanParams {
    len: u32,
    blocks: u32,
}

#bindings

override RUN: u32 = 16u;
override MOST: u32 = 0xffffffffu; // 1 counts flags, whatever their value
override SCANNED: u32 = 0u; // 1 if `sums` holds prefix sums already

// A part of the sum of the blocks before this one: those of all invocations together are that sum. Neighbouring
// invocations read neighbouring words, and every workgroup reads the same ones, so they come from a cache.
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
