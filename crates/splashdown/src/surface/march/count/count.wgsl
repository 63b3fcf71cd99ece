#import gpu/index
#import surface/lattice
#import surface/slots
#import surface/signs

#bindings

// Per row: vertices in the low half, triangles in the high half. A block has at most 1,536 vertices
// and 2,560 triangles.
var<workgroup> tallies: array<u32, 64>;

fn sign_bits(row: u32) -> u32 {
    return signs[row];
}

@compute @workgroup_size(64)
fn count(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) row: u32,
) {
    let slot = linear_group(group, groups);
    let is_filled = slot < status.blocks;
    var edges = 0u;
    var counters = 0u;
    if is_filled {
        let place = block_place(block_list[slot]);
        let y = row & 7u;
        let z = row >> 3u;
        let here = vec4<u32>(
            row_signs(place, y, z),
            row_signs(place, y + 1u, z),
            row_signs(place, y, z + 1u),
            row_signs(place, y + 1u, z + 1u),
        );
        let x_edges = (here.x ^ (here.x >> 1u)) & 255u;
        let y_edges = (here.x ^ here.y) & 255u;
        let z_edges = (here.x ^ here.z) & 255u;
        edges = x_edges | (y_edges << 8u) | (z_edges << 16u);
        counters = countOneBits(edges);
        edges |= here.x << 24u;
        for (var x = 0u; x < 8u; x++) {
            counters += (cases[cell_case(here, x)].y >> 28u) << 16u;
        }
    }
    tallies[row] = counters;
    workgroupBarrier();
    if is_filled {
        var before = 0u;
        for (var i = 0u; i < row; i++) {
            before += tallies[i];
        }
        rows[slot * 64u + row] = vec2<u32>(edges, before);
        if row == 63u {
            vertex_counts[slot] = (before + counters) & 0xffffu;
            triangle_counts[slot] = (before + counters) >> 16u;
        }
    }
}
