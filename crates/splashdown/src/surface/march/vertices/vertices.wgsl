#import gpu/index
#import surface/lattice
#import surface/walls
#import surface/slots

#bindings

// The value at a node of the lattice; zero in blocks that are not marked.
fn value(node: vec3<i32>) -> f32 {
    let slot = slot_at(node >> vec3<u32>(3u));
    if slot == NONE {
        return 0.0;
    }
    let local = vec3<u32>(node & vec3<i32>(7));
    return field_values[(slot * 64u + local.z * 8u + local.y) * 8u + local.x];
}

// A loop instead of six terms: browsers that inline every call took minutes to compile the latter.
fn gradient(node: vec3<i32>) -> vec3<f32> {
    var sum = vec3<f32>();
    for (var axis = 0u; axis < 3u; axis++) {
        let step = vec3<i32>(vec3<u32>(axis) == vec3<u32>(0u, 1u, 2u));
        let distance = (node_position(node + step) - node_position(node - step))[axis];
        sum += vec3<f32>(step) * (value(node + step) - value(node - step)) * (lattice.cell_size / distance);
    }
    return sum;
}

@compute @workgroup_size(64)
fn vertices(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) row: u32,
) {
    let slot = linear_group(group, groups);
    if slot >= status.blocks {
        return;
    }
    let start = block_place(block_list[slot]) * 8 + vec3<i32>(0, i32(row & 7u), i32(row >> 3u));
    let row_data = rows[slot * 64u + row];
    var number = vertex_starts[slot] + (row_data.y & 0xffffu);
    var edges = row_data.x & 0xffffffu;
    while edges != 0u && number < lattice.vertex_capacity {
        let edge = firstTrailingBit(edges);
        edges &= edges - 1u;
        let axis = edge >> 3u;
        let node = start + vec3<i32>(i32(edge & 7u), 0, 0);
        let step = vec3<i32>(vec3<u32>(axis) == vec3<u32>(0u, 1u, 2u));
        let a = value(node);
        let b = value(node + step);
        let along = vec3<f32>(step);
        let place = node_position(node);
        // Distance of both ends from the nearer wall of this axis, in m; negative behind it.
        let front = wall_distances(place)[axis];
        let next_place = node_position(node + step);
        let edge_length = next_place[axis] - place[axis];
        let next_front = wall_distances(next_place)[axis];
        let is_inside = a >= lattice.iso_level && front > lattice.wall_margin;
        let is_next_inside = b >= lattice.iso_level && next_front > lattice.wall_margin;
        let crosses = (is_inside && next_front <= lattice.wall_margin) || (is_next_inside && front <= lattice.wall_margin);
        var t = clamp((lattice.iso_level - a) / (b - a), 0.001, 0.999);
        // From the end that is inside: where the field reaches the iso level, and where the wall is.
        let depth = select(next_front, front, is_inside);
        let falls = select(a, b, is_inside) < lattice.iso_level;
        let of_field = select(1.0 - t, t, is_inside) * edge_length;
        if crosses && !(falls && of_field < depth) {
            // The wall on the side of the outer end.
            let is_upper = is_inside;
            let wall = select(lattice.wall_low[axis], lattice.wall_high[axis], is_upper);
            let at = select(place, vec3<f32>(wall), along > vec3<f32>(0.0));
            vertex_positions[number] = vec4<f32>(at, 0.0);
            normals[number] = vec4<f32>(select(-along, along, is_upper), 0.0);
            number++;
            continue;
        }
        var outwards = -mix(gradient(node), gradient(node + step), t);
        let length2 = dot(outwards, outwards);
        if length2 > 1e-20 {
            outwards *= inverseSqrt(length2);
        } else {
            // The gradient is zero: use the direction from the inside end to the outside end.
            outwards = select(-along, along, a > b);
        }
        vertex_positions[number] = vec4<f32>(place + along * (t * edge_length), 0.0);
        normals[number] = vec4<f32>(outwards, 0.0);
        number++;
    }
}
