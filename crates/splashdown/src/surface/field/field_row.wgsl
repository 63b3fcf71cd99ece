// A row of eight nodes of the field; needs the bindings of a field, and a function `contribution` of the pass: what sample i
// with a reflection adds to the nodes of a row.

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

// Evaluates a row of a block and writes its values and signs.
fn evaluate_row(slot: u32, row: u32) {
    let node = block_place(block_list[slot]) * 8 + vec3<i32>(0, i32(row & 7u), i32(row >> 3u));
    let numbers = vec4<u32>(u32(node.x)) + vec4<u32>(0u, 1u, 2u, 3u);
    let low_x = folded_x(node_positions_x(numbers));
    let high_x = folded_x(node_positions_x(numbers + vec4<u32>(4u)));
    let start = folded(node_position(node));
    let least = min(low_x, high_x);
    let most = max(low_x, high_x);
    let first_x = min(min(least.x, least.y), min(least.z, least.w));
    let last_x = max(max(most.x, most.y), max(most.z, most.w));
    let nodes = RowNodes(low_x, high_x, first_x, last_x, start.yz);
    let reach = vec3<f32>(lattice.search_reach);
    let near_end = vec3<f32>(first_x, start.yz);
    let far_end = vec3<f32>(last_x, start.yz);
    let cells = cell_range(near_end - reach, far_end + reach);
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
    let first = (slot * 64u + row) * 8u;
    for (var i = 0u; i < 4u; i++) {
        field_values[first + i] = values.low[i];
        field_values[first + 4u + i] = values.high[i];
    }
    signs[slot * 64u + row] = row_signs(node, values.low, values.high);
}
