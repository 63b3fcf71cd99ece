// Sums over a workgroup of 64 in a fixed order.
var<workgroup> group_sums: array<vec4<f32>, 64>;

// The sum of `own` over the workgroup. Every invocation of the workgroup calls it.
fn sum_of_group(local: u32, own: vec4<f32>) -> vec4<f32> {
    group_sums[local] = own;
    workgroupBarrier();
    for (var half = 32u; half > 0u; half /= 2u) {
        if (local < half) {
            group_sums[local] += group_sums[local + half];
        }
        workgroupBarrier();
    }
    return group_sums[0];
}
