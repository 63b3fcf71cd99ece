#import gpu/index
#import sph/grid
#import surface/lattice
#import surface/walls
#import sph/kernel
#import surface/candidates
#import surface/field_row

#bindings

// The ball of a sample.
fn contribution(i: u32, by: WallReflection, nodes: RowNodes) -> RowValues {
    let sample = samples[i];
    let at = by.sign * sample.xyz + by.shift;
    let d = nodes.yz - at.yz;
    let d2 = dot(d, d);
    let outside = distance_outside(nodes, at.x);
    if d2 + outside * outside >= lattice.support_radius * lattice.support_radius {
        return RowValues(vec4<f32>(0.0), vec4<f32>(0.0));
    }
    let a = nodes.low_x - at.x;
    let b = nodes.high_x - at.x;
    return RowValues(
        sample.w * kernel_w4(sqrt(a * a + d2) * lattice.inverse_support),
        sample.w * kernel_w4(sqrt(b * b + d2) * lattice.inverse_support),
    );
}

@compute @workgroup_size(64)
fn field(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) row: u32,
) {
    let slot = linear_group(group, groups);
    if slot < status.blocks {
        evaluate_row(slot, row);
    }
}
