// The prefix sums of one value per invocation over a workgroup of 256, with two barriers.
//
// Sixteen invocations sum sixteen rows of sixteen. The usual tree needs eight barriers, which are slow on software
// drivers. `half` is 0 or 1, alternating if called in a loop, which saves a third barrier.
var<workgroup> prefix_values: array<u32, 512>;
var<workgroup> prefix_rows: array<u32, 32>;

struct Prefix {
    before: u32, // sum over the invocations before this one
    total: u32,  // sum over all
}

// The prefix sums of `value`, and the sum of `other` over all invocations.
struct PrefixAndSum {
    prefix: Prefix,
    sum: u32,
}

fn workgroup_prefix(value: u32, lane: u32, half: u32) -> Prefix {
    let place = half * 256u + lane;
    prefix_values[place] = value;
    workgroupBarrier();
    if (lane < 16u) {
        let begin = half * 256u + lane * 16u;
        var sum = 0u;
        for (var i = begin; i < begin + 16u; i++) {
            let next = prefix_values[i];
            prefix_values[i] = sum;
            sum += next;
        }
        prefix_rows[half * 16u + lane] = sum;
    }
    workgroupBarrier();
    var prefix = Prefix(prefix_values[place], 0u);
    for (var row = 0u; row < 16u; row++) {
        let sum = prefix_rows[half * 16u + row];
        prefix.before += select(0u, sum, row < lane / 16u);
        prefix.total += sum;
    }
    return prefix;
}

// Of two values at once, with the same two barriers.
fn workgroup_prefix_and_sum(value: u32, other: u32, lane: u32) -> PrefixAndSum {
    prefix_values[lane] = value;
    prefix_values[256u + lane] = other;
    workgroupBarrier();
    if (lane < 32u) {
        var sum = 0u;
        for (var i = lane * 16u; i < lane * 16u + 16u; i++) {
            let next = prefix_values[i];
            prefix_values[i] = sum;
            sum += next;
        }
        prefix_rows[lane] = sum;
    }
    workgroupBarrier();
    var result = PrefixAndSum(Prefix(prefix_values[lane], 0u), 0u);
    for (var row = 0u; row < 16u; row++) {
        let sum = prefix_rows[row];
        result.prefix.before += select(0u, sum, row < lane / 16u);
        result.prefix.total += sum;
        result.sum += prefix_rows[16u + row];
    }
    return result;
}
