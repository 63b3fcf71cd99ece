#import gpu/index
#import surface/lattice
#import surface/slots
#import surface/signs

#bindings

fn sign_bits(row: u32) -> u32 {
    return rows[row].x >> 24u;
}

// The index of the vertex on an edge (numbered as in marching_cubes.rs) of the cell at a node of the
// lattice.
fn vertex_on(cell: vec3<i32>, edge: u32) -> u32 {
    let axis = edge >> 2u;
    let a = i32(edge & 1u);
    let b = i32((edge >> 1u) & 1u);
    var node = cell;
    if axis == 0u {
        node += vec3<i32>(0, a, b);
    } else if axis == 1u {
        node += vec3<i32>(a, 0, b);
    } else {
        node += vec3<i32>(a, b, 0);
    }
    let slot = slot_at(node >> vec3<u32>(3u));
    if slot == NONE {
        return NONE;
    }
    let local = vec3<u32>(node & vec3<i32>(7));
    let row = rows[slot * 64u + local.z * 8u + local.y];
    let below = row.x & ((1u << (8u * axis + local.x)) - 1u);
    return vertex_starts[slot] + (row.y & 0xffffu) + countOneBits(below);
}

@compute @workgroup_size(64)
fn triangles(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) row: u32,
) {
    let slot = linear_group(group, groups);
    if slot >= status.blocks {
        return;
    }
    let place = block_place(block_list[slot]);
    let y = row & 7u;
    let z = row >> 3u;
    let here = vec4<u32>(
        row_signs(place, y, z),
        row_signs(place, y + 1u, z),
        row_signs(place, y, z + 1u),
        row_signs(place, y + 1u, z + 1u),
    );
    if all(here == vec4<u32>(0u)) || all(here == vec4<u32>(0x1ffu)) {
        return;
    }
    var number = triangle_starts[slot] + (rows[slot * 64u + row].y >> 16u);
    for (var x = 0u; x < 8u; x++) {
        let packed = cases[cell_case(here, x)];
        let cell = place * 8 + vec3<i32>(vec3<u32>(x, y, z));
        let count = packed.y >> 28u;
        for (var i = 0u; i < count; i++) {
            var corners: vec3<u32>;
            for (var k = 0u; k < 3u; k++) {
                let bit = 4u * (3u * i + k);
                let word = select(packed.y, packed.x, bit < 32u);
                corners[k] = vertex_on(cell, (word >> (bit & 31u)) & 15u);
            }
            if any(corners >= vec3<u32>(lattice.vertex_capacity)) {
                corners = vec3<u32>(0u);
            }
            if number < lattice.triangle_capacity {
                indices[3u * number] = corners.x;
                indices[3u * number + 1u] = corners.y;
                indices[3u * number + 2u] = corners.z;
            }
            number++;
        }
    }
}
