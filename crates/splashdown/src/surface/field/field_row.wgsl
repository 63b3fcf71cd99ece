// Rows of eight nodes of the field; needs the bindings of a field.

// Coordinates x of the nodes, lower and upper four, as the field is evaluated there; their extent; and y and z.
struct RowNodes {
    low_x: vec4<f32>,
    high_x: vec4<f32>,
    first_x: f32,
    last_x: f32,
    yz: vec2<f32>,
}

// Values at the lower and upper four nodes.
struct RowValues {
    low: vec4<f32>,
    high: vec4<f32>,
}

fn kernel_w4(q: vec4<f32>) -> vec4<f32> {
    return vec4<f32>(kernel_w(q.x), kernel_w(q.y), kernel_w(q.z), kernel_w(q.w));
}

// The distance of a coordinate x from the ends of a row.
fn distance_outside(nodes: RowNodes, x: f32) -> f32 {
    return max(max(nodes.first_x - x, x - nodes.last_x), 0.0);
}

// The first node of a row of a block.
fn first_node(slot: u32, row: u32) -> vec3<i32> {
    return block_place(block_list[slot]) * 8 + vec3<i32>(0, i32(row & 7u), i32(row >> 3u));
}

// The row that begins at a node.
fn row_nodes(node: vec3<i32>) -> RowNodes {
    let numbers = vec4<u32>(u32(node.x)) + vec4<u32>(0u, 1u, 2u, 3u);
    let low_x = folded_x(node_positions_x(numbers));
    let high_x = folded_x(node_positions_x(numbers + vec4<u32>(4u)));
    let least = min(low_x, high_x);
    let most = max(low_x, high_x);
    let first_x = min(min(least.x, least.y), min(least.z, least.w));
    let last_x = max(max(most.x, most.y), max(most.z, most.w));
    return RowNodes(low_x, high_x, first_x, last_x, folded(node_position(node)).yz);
}

// Writes the values and signs of a row.
fn write_row(slot: u32, row: u32, values: RowValues) {
    let first = (slot * 64u + row) * 8u;
    for (var i = 0u; i < 4u; i++) {
        field_values[first + i] = values.low[i];
        field_values[first + 4u + i] = values.high[i];
    }
    signs[slot * 64u + row] = row_signs(first_node(slot, row), values.low, values.high);
}
