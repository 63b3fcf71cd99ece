#import gpu/index
#import sph/grid
#import surface/lattice
#import sph/kernel
#import surface/candidates

#bindings

fn kernel_w4(q: vec4<f32>) -> vec4<f32> {
    return vec4<f32>(kernel_w(q.x), kernel_w(q.y), kernel_w(q.z), kernel_w(q.w));
}

@compute @workgroup_size(64)
fn field(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) row: u32,
) {
    let slot = linear_group(group, groups);
    if slot >= status.blocks {
        return;
    }
    let node = block_place(block_list[slot]) * 8 + vec3<i32>(0, i32(row & 7u), i32(row >> 3u));
    let start = node_position(node);
    let low_x = lattice.origin.x + lattice.cell_size * (f32(node.x) + vec4<f32>(0.0, 1.0, 2.0, 3.0));
    let high_x = lattice.origin.x + lattice.cell_size * (f32(node.x) + vec4<f32>(4.0, 5.0, 6.0, 7.0));
    let reach = vec3<f32>(lattice.support_radius);
    let support2 = lattice.support_radius * lattice.support_radius;
    let cells = cell_range(start - reach, vec3<f32>(high_x.w, start.yz) + reach);
    var low = vec4<f32>(0.0);
    var high = vec4<f32>(0.0);
    for (var z = cells.first.z; z < cells.last.z; z++) {
        for (var y = cells.first.y; y < cells.last.y; y++) {
            let cell_row = (z * grid.size_y + y) * grid.size_x;
            let end = cell_start[cell_row + cells.last.x];
            for (var i = cell_start[cell_row + cells.first.x]; i < end; i++) {
                let sample = samples[i];
                let d = start.yz - sample.yz;
                let d2 = dot(d, d);
                // Distance of the particle from the ends of the row along x.
                let outside = max(max(low_x.x - sample.x, sample.x - high_x.w), 0.0);
                if d2 + outside * outside < support2 {
                    let a = low_x - sample.x;
                    let b = high_x - sample.x;
                    low += sample.w * kernel_w4(sqrt(a * a + d2) * lattice.inverse_support);
                    high += sample.w * kernel_w4(sqrt(b * b + d2) * lattice.inverse_support);
                }
            }
        }
    }
    let first = (slot * 64u + row) * 8u;
    var inside = 0u;
    for (var i = 0u; i < 4u; i++) {
        field_values[first + i] = low[i];
        field_values[first + 4u + i] = high[i];
        inside |= select(0u, 1u << i, low[i] >= lattice.iso_level);
        inside |= select(0u, 16u << i, high[i] >= lattice.iso_level);
    }
    signs[slot * 64u + row] = inside;
}
