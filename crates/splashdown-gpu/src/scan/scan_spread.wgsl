#import gpu/index
#import gpu/workgroup_prefix
#import gpu/scan_params

#bindings

override RUN: u32 = 8u; // at most 8
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

fn is_in_run(first: u32, i: u32) -> bool {
    return i < RUN && first + i < params.len;
}

fn count_at(first: u32, i: u32) -> u32 {
    return select(0u, min(counts[min(first + i, max(params.len, 1u) - 1u)], MOST), is_in_run(first, i));
}

fn store(first: u32, i: u32, start: u32) {
    if (is_in_run(first, i)) {
        starts[first + i] = start;
    }
}

@compute @workgroup_size(256)
fn scan_spread(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let block = min(linear_group(group, groups), params.blocks);
    let first = (block * 256u + lane) * RUN;
    // Without loops, whose checks would keep the loads from overlapping.
    let low = vec4(count_at(first, 0u), count_at(first, 1u), count_at(first, 2u), count_at(first, 3u));
    let high = vec4(count_at(first, 4u), count_at(first, 5u), count_at(first, 6u), count_at(first, 7u));
    let pairs = low + high;
    let found = workgroup_prefix_and_sum(pairs.x + pairs.y + pairs.z + pairs.w, part_before(block, lane), lane);
    let start = found.sum + found.prefix.before;
    let next = start + low.x + low.y + low.z + low.w;
    store(first, 0u, start);
    store(first, 1u, start + low.x);
    store(first, 2u, start + low.x + low.y);
    store(first, 3u, start + low.x + low.y + low.z);
    store(first, 4u, next);
    store(first, 5u, next + high.x);
    store(first, 6u, next + high.x + high.y);
    store(first, 7u, next + high.x + high.y + high.z);
    if (block + 1u == params.blocks && lane == 0u) {
        starts[params.len] = found.sum + found.prefix.total;
    }
}
