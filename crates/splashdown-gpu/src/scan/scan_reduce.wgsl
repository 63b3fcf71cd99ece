#import gpu/index
#import gpu/workgroup_prefix
#import gpu/scan_params

#bindings

override RUN: u32 = 8u; // at most 8
override MOST: u32 = 0xffffffffu; // 1 treats every value other than 0 as 1

fn count_at(first: u32, i: u32) -> u32 {
    let at = first + i * 256u;
    return select(0u, min(counts[min(at, max(params.len, 1u) - 1u)], MOST), i < RUN && at < params.len);
}

@compute @workgroup_size(256)
fn scan_reduce(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let block = linear_group(group, groups);
    let first = block * 256u * RUN + lane;
    // Neighbouring invocations read neighbouring words: the order of the sum over a block is arbitrary. Without a loop, whose
    // checks would keep the loads from overlapping.
    let low = vec4(count_at(first, 0u), count_at(first, 1u), count_at(first, 2u), count_at(first, 3u));
    let high = vec4(count_at(first, 4u), count_at(first, 5u), count_at(first, 6u), count_at(first, 7u));
    let pairs = low + high;
    let prefix = workgroup_prefix(pairs.x + pairs.y + pairs.z + pairs.w, lane, 0u);
    if (lane == 0u && block < params.blocks) {
        sums[block] = prefix.total;
    }
}
