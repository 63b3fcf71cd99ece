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

fn evaluate_row(slot: u32, row: u32) {
    let nodes = row_nodes(first_node(slot, row));
    let near_end = vec3<f32>(nodes.first_x, nodes.yz);
    let far_end = vec3<f32>(nodes.last_x, nodes.yz);
    let cells = cell_range(near_end - lattice.search_reach, far_end + lattice.search_reach);
    var values = RowValues(vec4<f32>(0.0), vec4<f32>(0.0));
    for (var left = wall_reflections(near_end, far_end); left != 0u; left &= left - 1u) {
        let by = wall_reflection(firstTrailingBit(left));
        for (var z = cells.first.z; z < cells.last.z; z++) {
            for (var y = cells.first.y; y < cells.last.y; y++) {
                let cell_row = (z * grid.size_y + y) * grid.size_x;
                let end = cell_start[cell_row + cells.last.x];
                for (var i = cell_start[cell_row + cells.first.x]; i < end; i++) {
                    let more = contribution(i, by, nodes);
                    values.low += more.low;
                    values.high += more.high;
                }
            }
        }
    }
    write_row(slot, row, values);
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
