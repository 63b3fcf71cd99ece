#import gpu/workgroup_prefix
#import gpu/scan_params

#bindings

const RUN: u32 = 16u;
override MOST: u32 = 0xffffffffu; // 1 treats every value other than 0 as 1

@compute @workgroup_size(256)
fn scan_single(@builtin(local_invocation_index) lane: u32) {
    var carry = 0u;
    let rounds = (params.len + 256u * RUN - 1u) / (256u * RUN);
    for (var round = 0u; round < rounds; round++) {
        let first = (round * 256u + lane) * RUN;
        let end = min(first + RUN, params.len);
        var sum = 0u;
        for (var i = first; i < end; i++) {
            sum += min(counts[i], MOST);
        }
        let prefix = workgroup_prefix(sum, lane, round & 1u);
        var start = carry + prefix.before;
        for (var i = first; i < end; i++) {
            starts[i] = start;
            start += min(counts[i], MOST);
        }
        carry += prefix.total;
    }
    if (lane == 0u) {
        starts[params.len] = carry;
    }
}
